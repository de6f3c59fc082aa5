// motion.glb as others read it: Khronos' validator finds nothing, and three's loader and mixer move
// the links as the joint log says.
// usage: node glb_test.mjs AIRCUT BUILD/web
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';
import {pathToFileURL} from 'node:url';

const [aircut, web] = process.argv.slice(2).map(p => path.resolve(p));
const from_web = createRequire(web + '/');
const validator = from_web('gltf-validator');
const modules = name => import(pathToFileURL(path.join(web, 'node_modules/three', name)));
const {AnimationMixer, LoopOnce, Vector3} = await modules('build/three.module.js');
const {GLTFLoader} = await modules('examples/jsm/loaders/GLTFLoader.js');
globalThis.self ??= globalThis;

const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'aircut-glb-'));
process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));

async function animation(program, machine, ...more) {
  const out = fs.mkdtempSync(folder + '/out-');
  try {
    execFileSync(aircut, ['run', program, '-m', machine, '-o', out, '--force', '--frames', 'none', '--motion', 'glb', ...more],
      {stdio: 'pipe'});
  } catch (problem) {
    assert.equal(problem.status, 1, String(problem.stderr));  // a verdict of fail is fine
  }
  const bytes = fs.readFileSync(out + '/motion.glb');
  const issues = (await validator.validateBytes(new Uint8Array(bytes))).issues;
  assert.deepEqual([issues.numErrors, issues.numWarnings], [0, 0], JSON.stringify(issues.messages.slice(0, 5)));
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const gltf = await new Promise((done, failed) => new GLTFLoader().parse(buffer, '', done, failed));
  const mixer = new AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[0]).setLoop(LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  const lines = fs.readFileSync(out + '/joints.csv', 'utf8').split('\n').filter(line => line && !line.startsWith('#'));
  const head = lines[0].split(',');
  const rows = lines.slice(1).map(line => line.split(','));
  return {
    scene: gltf.scene, end: gltf.animations[0].duration,
    at: t => { mixer.setTime(t); gltf.scene.updateMatrixWorld(true); },
    place: name => gltf.scene.getObjectByName(name).getWorldPosition(new Vector3()).multiplyScalar(1000),
    rows, column: name => head.indexOf(name),
  };
}

// X and Y carry the table, Z the head; glTF's Y is the machine's Z, its Z the machine's −Y.
const mill = await animation('programs/rapid-through-block.ngc', 'machines/mill3', '--setup', 'programs/mill3-block.setup.toml');
mill.at(0);
const table = mill.place('table'), head = mill.place('head');
const t = mill.column('t'), [x, y, z] = ['q0', 'q1', 'q2'].map(name => mill.column(name));
assert.ok(t >= 0 && x >= 0 && y >= 0 && z >= 0);
let moved = 0;
for (let i = 0; i < mill.rows.length; i += 997) {
  const row = mill.rows[i].map(Number);
  mill.at(row[t]);
  const there = mill.place('table'), spindle = mill.place('head');
  const first = mill.rows[0].map(Number);
  const is = [Math.abs(there.x - table.x), Math.abs(there.z - table.z), spindle.y - head.y];
  const wanted = [Math.abs(row[x] - first[x]), Math.abs(row[y] - first[y]), row[z] - first[z]];
  is.forEach((v, k) => assert.ok(Math.abs(v - wanted[k]) < 0.05, `row ${i}: ${is} is not ${wanted}`));
  moved = Math.max(moved, ...wanted);
  // One stage of the stock at a time.
  let stages = 0;
  mill.scene.traverse(o => { if (/shape$/.test(o.name) && /stock/.test(o.name) && o.scale.x > 0.5) ++stages; });
  assert.equal(stages, 1, `stages of the stock at row ${i}`);
}
assert.ok(moved > 50);
const cutter = () => mill.scene.getObjectByName('T1cutter_shape').scale.x;
mill.at(0);
assert.equal(cutter(), 0);
mill.at(mill.end - 0.001);
assert.equal(cutter(), 1);
console.log('ok    links, stock and tool move as the log says');

const cone = await animation('programs/ac-cone.ngc', 'machines/mill5-ac');
assert.ok(cone.end > 1);
console.log('ok    a machine with rotary joints is valid');
