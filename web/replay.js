// The replay: machine, tool, stock and path in 3D, moved along the run's keys. Between two keys
// everything is linear in time (src/page/replay.h).
import {
  BufferAttribute, BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineSegments, Mesh,
  PerspectiveCamera, Plane, Quaternion, Scene, Box3, Sphere, SphereGeometry, MeshBasicMaterial, Vector3, WebGLRenderer,
} from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';
import {surfaces} from './surface.js';

const kinds = ['waiting', 'rapid', 'feed', 'arc', 'tool change', 'probe', 'dwell', 'thread', 'blend'];
const views = {
  iso: [1, -1.25, 0.9], front: [0, -1, 0.0001], top: [0, -0.0001, 1], right: [1, 0, 0.0001], left: [-1, 0, 0.0001],
};

// Index of the last key at or before t.
function before(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

function geometry(packed, integers) {
  const flat = integers(packed.corners), n = flat.length / 3;
  const corners = new Float32Array(flat.length);
  for (let axis = 0; axis < 3; ++axis)
    for (let i = 0; i < n; ++i) corners[3 * i + axis] = packed.min[axis] + packed.unit * flat[axis * n + i];
  const out = new BufferGeometry();
  out.setAttribute('position', new BufferAttribute(corners, 3));
  out.setIndex(new BufferAttribute(integers(packed.indices, Uint32Array), 1));
  return out;
}

export function replay(host, {run, integers, numbers, text, make, fixed}) {
  const view = make('div', {class: 'view'});
  const status = make('div', {class: 'status', 'aria-live': 'off'});
  const renderer = new WebGLRenderer({antialias: false, preserveDrawingBuffer: true});
  renderer.domElement.tabIndex = 0;
  renderer.domElement.setAttribute('aria-label', 'the machine in 3D; drag to turn, wheel to zoom');
  view.append(renderer.domElement, status);

  // ---- keys ----------------------------------------------------------------------------------
  const count = run.keys.count;
  const times = numbers(run.keys.t, count), feeds = numbers(run.keys.feed, count);
  const rapids = numbers(run.keys.rapid, count);
  const tips = run.keys.tip.map(row => numbers(row, count));
  const joints = run.joints.map(j => ({...j, values: numbers(j.values, count)}));
  const end = times[count - 1];
  const blocks = {t: numbers(run.blocks.t, run.blocks.count), line: numbers(run.blocks.line, run.blocks.count),
                  kind: numbers(run.blocks.kind, run.blocks.count)};

  // ---- scene ---------------------------------------------------------------------------------
  const scene = new Scene();
  const world = new Group();  // Z up
  scene.add(world);
  const camera = new PerspectiveCamera(35, 1, 1, 100000);
  camera.up.set(0, 0, 1);
  const controls = new OrbitControls(camera, renderer.domElement);
  controls.enableDamping = false;
  scene.add(camera);
  const section = new Plane(new Vector3(0, 1, 0), 1e9);
  const look_of = surfaces(section);

  const links = run.links.map(link => {
    const group = new Group();
    group.matrixAutoUpdate = false;
    world.add(group);
    const rows = link.rows.map(row => numbers(row, count));
    const still = link.rows.every(row => 'all' in row);
    return {group, rows, still, placed: false};
  });
  // Both shapes of a body, made when they are first needed.
  function shapes(packed) {
    const made = {};
    return fine => made[fine] ??= fine || !packed.coarse ? geometry(packed.mesh, integers) : geometry(packed.coarse, integers);
  }
  const red = new Color('#ff3b30'), none = new Color(0, 0, 0);
  const parts = [];
  function place(item, mesh) {
    const pose = new Group();
    pose.matrixAutoUpdate = false;
    pose.matrix.fromArray(item.pose);
    pose.add(mesh);
    links[item.link].group.add(pose);
    return pose;
  }
  for (const body of run.bodies) {
    const shape = shapes(body), mesh = new Mesh(shape(true), look_of.material(body.color));
    parts.push({...body, shape, object: mesh, pose: place(body, mesh), hidden: false});
  }
  // Stock as it was from each stage on takes the place of its raw body.
  const raw = parts.find(part => part.role === 'stock');
  const stages = run.stock.map(stage => ({t: stage.t, shape: shapes(stage)}));

  // ---- path, in the frame of the work --------------------------------------------------------
  const workGroup = new Group();
  workGroup.matrixAutoUpdate = false;
  workGroup.matrix.fromArray(run.work.pose);
  links[run.work.link].group.add(workGroup);
  function lines(color, wanted, opacity) {
    const points = [];
    for (let i = 1; i < count; ++i)
      if ((rapids[i] > 0) === wanted)
        points.push(tips[0][i - 1], tips[1][i - 1], tips[2][i - 1], tips[0][i], tips[1][i], tips[2][i]);
    const shape = new BufferGeometry();
    shape.setAttribute('position', new Float32BufferAttribute(points, 3));
    const object = new LineSegments(shape, new LineBasicMaterial({color, transparent: true, opacity}));
    workGroup.add(object);
    return object;
  }
  const paths = [lines('#e0a100', true, 0.45), lines('#1e88e5', false, 0.85)];

  const marker = new Mesh(new SphereGeometry(1, 24, 16), new MeshBasicMaterial({color: red, depthTest: false, transparent: true, opacity: 0.8}));
  marker.renderOrder = 10;
  marker.visible = false;
  world.add(marker);

  // ---- controls ------------------------------------------------------------------------------
  let fine = true, slow = false, ratio = 1, drawnAt = 0, late = 0;  // the picture
  let now = 0, playing = false, speed = 1, drawn = -1, wanted = true, finding = null;
  const slider = make('input', {type: 'range', min: 0, max: 1000000, value: 0, class: 'timeline', 'aria-label': 'time'});
  const play = make('button', {'aria-pressed': 'false', title: 'space'}, 'play');
  const speeds = make('select', {'aria-label': 'speed'},
    ...[0.1, 0.5, 1, 2, 5, 10, 50, 200].map(s => make('option', {value: s, selected: s === 1}, s + '×')));
  const back = make('button', {title: 'left arrow: one block back'}, '◀ block');
  const forth = make('button', {title: 'right arrow: one block on'}, 'block ▶');
  const cameras = make('select', {'aria-label': 'camera'},
    ...['iso', 'front', 'top', 'right', 'left', 'follow tool'].map(name => make('option', {value: name}, name)));
  const fit = make('button', {title: 'F: fit all into the view'}, 'fit');
  const axis = make('select', {'aria-label': 'section plane'},
    ...['no section', 'section X', 'section Y', 'section Z'].map((name, i) => make('option', {value: i - 1}, name)));
  const depth = make('input', {type: 'range', min: 0, max: 1000, value: 500, 'aria-label': 'place of the section', hidden: true});
  const showPath = make('input', {type: 'checkbox', checked: true});
  const marks = make('div', {class: 'marks', 'aria-hidden': 'true'});
  for (const f of run.report.findings) {
    if (f.t_worst_s === undefined || end <= 0) continue;
    const mark = make('i');
    mark.style.left = 100 * f.t_worst_s / end + '%';
    marks.append(mark);
  }
  const list = make('div', {class: 'bodies'});
  for (const part of parts) {
    const box = make('input', {type: 'checkbox', checked: true, onchange: () => {
      part.hidden = !box.checked;
      redraw();
    }});
    list.append(make('label', {}, box, ' ' + part.name));
  }
  const program = make('div', {class: 'program', tabIndex: 0, role: 'listbox', 'aria-label': 'program'});
  host.append(make('div', {class: 'stage'}, view, program),
    make('div', {class: 'controls'}, play, back, forth, speeds, make('div', {class: 'track'}, slider, marks), cameras, fit, axis, depth,
      make('label', {}, showPath, ' path')),
    make('details', {}, make('summary', {}, 'bodies'), list),
    ...[
      run.blocks.left_out ? 'The run has more blocks than this page holds: towards its end the line is not followed.' : '',
      run.program.left_out_bytes > 0 ? 'Of the program the last ' + run.program.left_out_bytes + ' bytes are not shown.' : '',
    ].filter(Boolean).map(what => make('p', {class: 'note'}, what)),
    make('p', {class: 'note'}, 'space play · ← → block · home, end · N next finding · F fit · blue feed, yellow rapid' +
      ' · moments between keys are within ' + fixed(run.tolerance_mm, 2) + ' mm'));

  // ---- program text beside it: only the lines in sight exist ---------------------------------
  const texts = text(run.program.text).split(/\r\n|\n|\r/);
  const bad = new Map();
  for (const f of run.report.findings)
    if (f.place && f.place.file === run.program.name) bad.set(f.place.line, f);
  const height = 20, most = 16000000;  // browsers end elements somewhere above that
  const scale = Math.min(1, most / (texts.length * height));
  const room = make('div');
  room.style.height = texts.length * height * scale + 'px';
  room.style.position = 'relative';
  program.append(room);
  let current = 0;
  function write() {
    const first = Math.max(0, Math.floor(program.scrollTop / scale / height) - 5);
    const last = Math.min(texts.length, first + Math.ceil(program.clientHeight / height) + 12);
    const nodes = [];
    for (let i = first; i < last; ++i) {
      const node = make('div', {class: (i + 1 === current ? 'now' : '') + (bad.has(i + 1) ? ' bad' : ''),
        onclick: () => seekLine(i + 1)}, make('span', {class: 'nr'}, String(i + 1)), texts[i]);
      node.style.top = program.scrollTop + (i * height - program.scrollTop / scale) + 'px';
      if (bad.has(i + 1)) node.title = bad.get(i + 1).message;
      nodes.push(node);
    }
    room.replaceChildren(...nodes);
  }
  program.addEventListener('scroll', write);
  function follow(line) {
    if (line === current) return;
    current = line;
    const top = (line - 1) * height * scale;
    if (line > 0 && (top < program.scrollTop + height || top > program.scrollTop + program.clientHeight - 2 * height))
      program.scrollTop = top - program.clientHeight / 2;
    write();
  }

  // ---- moving --------------------------------------------------------------------------------
  const a = new Quaternion(), b = new Quaternion(), at = new Vector3(), one = new Vector3(1, 1, 1);
  function move(t) {
    const i = before(times, t), k = Math.min(i + 1, count - 1);
    const share = times[k] > times[i] ? (t - times[i]) / (times[k] - times[i]) : 0;
    const mix = row => row[i] + share * (row[k] - row[i]);
    for (const link of links) {
      if (link.still && link.placed) continue;
      link.placed = true;
      const r = link.rows;
      at.set(mix(r[0]), mix(r[1]), mix(r[2]));
      a.set(r[3][i], r[4][i], r[5][i], r[6][i]).normalize();
      b.set(r[3][k], r[4][k], r[5][k], r[6][k]).normalize();
      link.group.matrix.compose(at, a.slerp(b, share), one);
    }
    let tool = 0;
    for (const change of run.tools.changes) if (change.t <= t) tool = change.number;
    for (const part of parts) part.object.visible = !part.hidden && (part.tool === undefined || part.tool === tool);
    if (raw && stages.length > 0) {
      let stage = stages[0];
      for (const s of stages) if (s.t <= t + 1e-9) stage = s;
      raw.shape = stage.shape;
    }
    for (const part of parts) if (part.object.visible) part.object.geometry = part.shape(fine);
    const block = before(blocks.t, t + 1e-9);
    const lineNow = blocks.t.length > 0 ? blocks.line[block] : 0;
    follow(lineNow);
    status.textContent = 't ' + t.toFixed(2) + ' s   line ' + (lineNow || '–') + '   ' +
      (kinds[blocks.kind[block]] ?? '') + '\n' +
      joints.map(j => j.name + ' ' + mix(j.values).toFixed(3)).join('  ') + '\n' +
      (tool ? 'T' + tool : 'no tool') + '   ' + mix(feeds).toFixed(0) + ' mm/min';
    slider.value = end > 0 ? 1000000 * t / end : 0;
    slider.setAttribute('aria-valuetext', t.toFixed(1) + ' s, line ' + lineNow);
    world.updateMatrixWorld(true);
    if (cameras.value === 'follow tool') {
      const tip = new Vector3(mix(tips[0]), mix(tips[1]), mix(tips[2])).applyMatrix4(workGroup.matrixWorld);
      camera.position.add(tip.clone().sub(controls.target));
      controls.target.copy(tip);
      controls.update();
    }
  }
  function mark(f) {
    finding = f;
    for (const part of parts) {
      const hit = f && (part.name === f.body_a || part.name === f.body_b);
      part.object.material.uniforms.glow.value.copy(hit ? red : none).multiplyScalar(0.55);
    }
    marker.visible = Boolean(f && f.points_mm && f.points_mm.length > 0);
    if (marker.visible) marker.position.fromArray(f.points_mm[0]);
  }

  // ---- drawing, only when something has changed ----------------------------------------------
  function redraw() {
    wanted = true;
  }
  // Edges are smooth by drawing twice as fine as the screen is. Where that takes too long, it waits
  // until the picture stands still, and the bodies that move are coarse.
  function sharpen(on) {
    fine = on;
    renderer.setPixelRatio(on ? Math.min(3, Math.max(devicePixelRatio, 2)) : Math.min(devicePixelRatio, ratio));
  }
  function size() {
    const {clientWidth: w, clientHeight: h} = view;
    if (w === 0 || h === 0) return;
    renderer.setSize(w, h, false);
    camera.aspect = w / h;
    camera.updateProjectionMatrix();
    redraw();
  }
  function hurry(stamp) {
    if (stamp - drawnAt < 300) {  // one of several in a row
      late = stamp - drawnAt > 40 ? late + 1 : Math.max(0, late - 1);
    }
    if (late > 3) {  // coarse bodies first, then fewer pixels
      if (slow) ratio = Math.max(0.5, 0.7 * ratio);
      slow = true;
      late = 0;
      sharpen(false);
    }
    if (slow && fine) sharpen(false);
    drawnAt = stamp;
  }
  function paint() {
    if (marker.visible) marker.scale.setScalar(camera.position.distanceTo(marker.position) / 90);
    camera.updateMatrixWorld();
    look_of.update(camera);
    renderer.render(scene, camera);
  }
  function box(only) {
    world.updateMatrixWorld(true);
    const all = new Box3();
    for (const part of parts)
      if (part.object.visible && (!only || only(part))) all.expandByObject(part.object, false);
    return all;
  }
  // What the job is about; empty when the set-up has nothing of the kind.
  function workBox() {
    const stock = box(part => part.role === 'stock' || part.role === 'part');
    return stock.isEmpty() ? box(part => part.role === 'fixture') : stock;
  }
  function look(direction, bounds) {
    const ball = bounds.getBoundingSphere(new Sphere());
    const angle = Math.min(camera.fov * Math.PI / 180, 2 * Math.atan(Math.tan(camera.fov * Math.PI / 360) * camera.aspect));
    const distance = Math.max(1, ball.radius) / Math.sin(angle / 2);
    controls.target.copy(ball.center);
    camera.position.copy(ball.center).addScaledVector(new Vector3(...direction).normalize(), distance);
    camera.near = distance / 500;
    camera.far = distance * 20;
    camera.updateProjectionMatrix();
    controls.update();
    redraw();
  }
  const background = () => new Color(getComputedStyle(document.documentElement).getPropertyValue('--back').trim());
  let last = performance.now();
  function tick(stamp) {
    const passed = Math.min(0.25, (stamp - last) / 1000);
    last = stamp;
    if (playing) {
      now = Math.min(end, now + passed * speed);
      if (now >= end) setPlaying(false);
    }
    if (wanted || now !== drawn) {
      wanted = false;
      drawn = now;
      hurry(stamp);
      move(now);
      paint();
    } else if (!fine && stamp - drawnAt > 200) {
      sharpen(true);
      move(now);
      paint();
    }
    requestAnimationFrame(tick);
  }
  function setPlaying(on) {
    playing = on;
    play.setAttribute('aria-pressed', String(on));
    play.textContent = on ? 'pause' : 'play';
  }
  function seek(t) {
    now = Math.min(end, Math.max(0, t));
    redraw();
  }
  function step(way) {
    setPlaying(false);
    const i = before(blocks.t, now + 1e-9);
    if (way > 0) return seek(i + 1 < blocks.t.length ? blocks.t[i + 1] : end);
    seek(now > blocks.t[i] + 1e-6 ? blocks.t[i] : blocks.t[Math.max(0, i - 1)]);
  }
  function seekLine(line) {
    for (let i = 0; i < blocks.line.length; ++i)
      if (blocks.line[i] >= line) return seek(blocks.t[i]);
  }
  function show(f) {
    setPlaying(false);
    seek(f.t_worst_s);
    move(now);
    mark(f);
    if (marker.visible) {
      const around = new Box3().setFromCenterAndSize(marker.position, new Vector3(160, 160, 160));
      look(views.iso, around);
    }
    renderer.domElement.focus({preventScroll: true});
  }
  function next() {
    const list = run.report.findings.filter(f => f.t_worst_s !== undefined);
    if (list.length === 0) return;
    show(list[(list.indexOf(finding) + 1) % list.length]);
  }
  function cut() {
    const i = Number(axis.value);
    depth.hidden = i < 0;
    look_of.cut(i >= 0);
    if (i >= 0) {
      const bounds = box();
      const low = bounds.min.getComponent(i), high = bounds.max.getComponent(i);
      section.normal.set(i === 0 ? -1 : 0, i === 1 ? 1 : 0, i === 2 ? -1 : 0);
      const place = low + (high - low) * Number(depth.value) / 1000;
      section.constant = i === 1 ? -place : place;
    }
    redraw();
  }

  play.onclick = () => {
    if (!playing && now >= end) now = 0;
    setPlaying(!playing);
  };
  back.onclick = () => step(-1);
  forth.onclick = () => step(1);
  speeds.onchange = () => { speed = Number(speeds.value); };
  slider.oninput = () => { setPlaying(false); seek(end * slider.value / 1000000); };
  cameras.onchange = () => { if (views[cameras.value]) look(views[cameras.value], box()); else redraw(); };
  fit.onclick = () => look(views[cameras.value] ?? views.iso, box());
  axis.onchange = () => {
    const i = Number(axis.value), work = workBox();
    if (i >= 0 && !work.isEmpty()) {  // begins in the middle of the work
      const all = box(), low = all.min.getComponent(i), high = all.max.getComponent(i);
      depth.value = 1000 * (work.getCenter(new Vector3()).getComponent(i) - low) / Math.max(1e-9, high - low);
    }
    cut();
  };
  depth.oninput = cut;
  showPath.onchange = () => { for (const path of paths) path.visible = showPath.checked; redraw(); };
  controls.addEventListener('change', redraw);
  new ResizeObserver(size).observe(view);
  addEventListener('themechange', () => { scene.background = background(); redraw(); });
  host.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tag = event.target.tagName;
    if ((tag === 'SELECT' || tag === 'INPUT' || tag === 'BUTTON') && event.key !== 'n' && event.key !== 'N' && event.key !== 'f') return;
    const act = {' ': () => play.onclick(), ArrowLeft: () => step(-1), ArrowRight: () => step(1), Home: () => seek(0),
      End: () => seek(end), n: next, N: next, f: () => fit.onclick(), F: () => fit.onclick()}[event.key];
    if (!act) return;
    event.preventDefault();
    act();
  });

  scene.background = background();
  sharpen(true);
  size();
  move(0);
  const work = workBox();
  look(views.iso, work.isEmpty() ? box() : work.expandByScalar(40));
  write();
  requestAnimationFrame(tick);
  return {seek, show, next, get time() { return now; }, get frames() { return renderer.info.render.frame; }};
}
