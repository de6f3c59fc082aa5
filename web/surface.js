// What bodies look like in the replay: one colour, facets lit from beside the camera. The shader is as
// cheap as it can be, because many a browser draws on the processor.
import {Color, DoubleSide, GLSL3, Plane, ShaderMaterial, Vector4} from 'three';

const vertex = `
out vec3 at;  // in the camera's frame
void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  at = place.xyz;
  gl_Position = projectionMatrix * place;
}`;

// A facet's normal is that of the plane through neighbouring pixels, so corners need none, and it
// faces the camera by itself. The square root stands for the screen's gamma.
const fragment = `
in vec3 at;
out vec4 seen;
uniform vec3 color, glow, up;
uniform vec4 section;
void main() {
#ifdef SECTION
  if (dot(section.xyz, at) + section.w < 0.0) discard;
#endif
  vec3 normal = normalize(cross(dFdx(at), dFdy(at)));
  vec3 paint = color;
#ifdef SECTION
  // Inside a body that is cut open: shown as the face of the cut, one even surface.
  if (!gl_FrontFacing) {
    normal = -section.xyz;
    paint *= 0.8;
  }
  // Before another body that begins right behind it.
  gl_FragDepth = gl_FragCoord.z * (gl_FrontFacing ? 1.0 : 0.9999996);
#endif
  float sun = max(dot(normal, vec3(0.32, 0.48, 0.816)), 0.0);
  float shine = max(dot(normal, vec3(0.168, 0.252, 0.953)), 0.0);
  shine *= shine; shine *= shine; shine *= shine; shine *= shine;
  vec3 light = mix(vec3(0.20, 0.19, 0.18), vec3(0.52, 0.53, 0.55), 0.5 + 0.5 * dot(normal, up));
  seen = vec4(sqrt(paint * (light + 0.62 * sun) + 0.10 * shine + glow), 1.0);
}`;

// Materials share the section plane and the way up; update(camera) brings both into its frame.
export function surfaces(section) {
  const up = {value: new Color()}, plane = {value: new Vector4()}, local = new Plane();
  const all = [];
  let cut = false;
  return {
    material(color) {
      const made = new ShaderMaterial({glslVersion: GLSL3, vertexShader: vertex, fragmentShader: fragment, side: DoubleSide,
        uniforms: {color: {value: new Color(color)}, glow: {value: new Color(0, 0, 0)}, up, section: plane}});
      all.push(made);
      return made;
    },
    // A discard costs even where nothing is cut, so it is compiled in only when wanted.
    cut(wanted) {
      if (cut === wanted) return;
      cut = wanted;
      for (const m of all) {
        m.defines = cut ? {SECTION: ''} : {};
        m.needsUpdate = true;
      }
    },
    update(camera) {
      const view = camera.matrixWorldInverse.elements;
      up.value.setRGB(view[8], view[9], view[10]);  // the world's Z
      local.copy(section).applyMatrix4(camera.matrixWorldInverse);
      plane.value.set(local.normal.x, local.normal.y, local.normal.z, local.constant);
    },
  };
}
