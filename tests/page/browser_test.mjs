// The report in a real browser: opens from disk, plays, jumps to a finding, loads nothing, takes no
// text of the inputs for markup, and shows pictures where there is no WebGL.
// usage: node browser_test.mjs AIRCUT BUILD/web      (AIRCUT_SHOTS=FOLDER keeps screenshots)
import assert from 'node:assert/strict';
import {execFileSync} from 'node:child_process';
import fs from 'node:fs';
import {createRequire} from 'node:module';
import os from 'node:os';
import path from 'node:path';

const [aircut, web] = process.argv.slice(2).map(p => path.resolve(p));
const {chromium} = createRequire(web + '/')('playwright-core');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'aircut-page-'));
process.on('exit', () => fs.rmSync(folder, {recursive: true, force: true}));
const shots = process.env.AIRCUT_SHOTS;

const made = new Map();
function run(program, ...more) {
  if (made.has(program)) return made.get(program);
  const out = fs.mkdtempSync(folder + '/out-');
  made.set(program, out + '/report.html');
  try {
    execFileSync(aircut, ['run', program, '-m', 'machines/mill3', '-o', out, '--force', '--frames', 'count=2',
      '--frames', 'finding', '--size', '640x480', ...more], {stdio: 'pipe'});
  } catch (problem) {
    assert.equal(problem.status, 1, String(problem.stderr));  // a verdict of fail is fine
  }
  return out + '/report.html';
}

const flags = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
  '--disable-component-update', '--disable-sync'];
const software = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
async function open(browser, file, size = {width: 1280, height: 900}) {
  const context = await browser.newContext({viewport: size});
  const page = await context.newPage();
  page.problems = [];
  page.on('console', m => { if (m.type() === 'error') page.problems.push(m.text()); });
  page.on('pageerror', e => page.problems.push(e.message));
  page.on('dialog', d => { page.problems.push('dialog ' + d.message()); d.dismiss(); });
  page.on('request', r => { if (r.url() !== 'file://' + encodeURI(file) && !r.url().startsWith('data:')) page.problems.push('loads ' + r.url()); });
  const start = Date.now();
  await page.goto('file://' + encodeURI(file));
  await page.waitForFunction(() => document.documentElement.dataset.ready === 'yes', null, {timeout: 60000});
  page.opened = Date.now() - start;
  return page;
}
// Share of the view's pixels for which `wanted(r, g, b)` holds, and a sum that tells pictures apart.
const pixels = page => page.evaluate(async () => {
  const canvas = document.querySelector('.view canvas');
  await new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)));
  const copy = document.createElement('canvas');
  copy.width = canvas.width;
  copy.height = canvas.height;
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const data = context.getImageData(0, 0, copy.width, copy.height).data;
  let red = 0, tan = 0, sum = 0;
  for (let i = 0; i < data.length; i += 4) {
    if (data[i] > 180 && data[i] > 1.6 * data[i + 1] && data[i] > 1.6 * data[i + 2]) ++red;
    if (data[i] > 120 && data[i] - data[i + 2] > 35 && data[i] - data[i + 1] < 60 && data[i] >= data[i + 1]) ++tan;
    sum = (sum * 31 + data[i] * 3 + data[i + 1] * 5 + data[i + 2] * 7) % 1000000007;
  }
  const n = data.length / 4;
  return {red: red / n, tan: tan / n, sum};
});
const time = page => page.evaluate(() => parseFloat(/t ([\d.]+) s/.exec(document.querySelector('.status').textContent)[1]));
const status = page => page.textContent('.status');
const shot = async (page, name) => shots && page.screenshot({path: path.join(shots, name + '.png'), fullPage: true});
const tests = {};

tests['opens, plays, steps by block and jumps to a finding'] = async browser => {
  const page = await open(browser, run('programs/holder-into-vise.ngc'));
  assert.match(await page.textContent('header'), /FAIL.*holder-into-vise/);
  assert.match(await page.textContent('#findings'), /T1\/holder.*vise\/fixed-jaw/);
  assert.equal(await time(page), 0);
  const first = await pixels(page);
  assert.ok(first.tan > 0.005, 'the block is in sight');
  await page.selectOption('select[aria-label=speed]', '10');
  await page.click('text=play');
  await page.waitForTimeout(1200);
  await page.keyboard.press('Escape');
  assert.ok(await time(page) > 2, 'it plays');
  await page.click('button.goto');
  await page.waitForFunction(() => /line 19/.test(document.querySelector('.status').textContent));
  const contact = await pixels(page);
  assert.ok(contact.red > 0.01, 'the colliding bodies are red: ' + contact.red);
  assert.notEqual(contact.sum, first.sum);
  assert.match(await page.textContent('.program .now'), /^19/);
  await shot(page, 'finding');
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => /line 20/.test(document.querySelector('.status').textContent));
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction(() => /line 19/.test(document.querySelector('.status').textContent));
  await page.keyboard.press('Home');
  await page.waitForFunction(() => /t 0\.00 s/.test(document.querySelector('.status').textContent));
  await page.keyboard.press('n');
  await page.waitForFunction(() => /line (19|20)/.test(document.querySelector('.status').textContent));
  const before = await pixels(page);
  await page.click('summary');
  await page.click('.bodies label:has-text("vise/fixed-jaw") input');
  const without = await pixels(page);
  assert.notEqual(without.sum, before.sum, 'a hidden body is not drawn');
  await page.selectOption('select[aria-label="section plane"]', {label: 'section X'});
  assert.notEqual((await pixels(page)).sum, without.sum, 'a section cuts bodies open');
  await page.click('text=theme');
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), 'dark');
  await page.click('#findings th button:has-text("line")');
  assert.equal(await page.getAttribute('#findings th[aria-sort]', 'aria-sort'), 'ascending');
  // Feed, linear joints, speeds, accelerations; the same over the lines, where a click seeks.
  assert.equal(await page.locator('#charts .uplot').count(), 4);
  await page.selectOption('#charts select', 'line');
  assert.equal(await page.locator('#charts .uplot').count(), 4);
  const over = page.locator('#charts .u-over').first();
  // With the mouse itself: a browser that draws slowly never counts as still.
  await over.evaluate(e => e.scrollIntoView({block: 'center', behavior: 'instant'}));
  const place = await over.boundingBox();
  await page.mouse.click(place.x + place.width - 2, place.y + 50);
  await page.waitForFunction(() => /line 23/.test(document.querySelector('.status').textContent));
  assert.deepEqual(page.problems, []);
};

tests['shows the stock as it is cut'] = async browser => {
  const page = await open(browser, run('programs/rapid-through-block.ngc', '--setup', 'programs/mill3-block.setup.toml'));
  await page.selectOption('select[aria-label=camera]', 'top');
  const whole = await pixels(page);
  await page.focus('.view canvas');
  await page.keyboard.press('End');
  await page.waitForTimeout(300);
  const cut = await pixels(page);
  assert.notEqual(cut.sum, whole.sum);
  assert.match(await page.textContent('#charts'), /material removed/);
  assert.match(await page.textContent('#stock'), /removed [\d.]+ cm³/);
  await shot(page, 'stock');
  assert.deepEqual(page.problems, []);
};

tests['hostile names and comments stay text'] = async browser => {
  const evil = '<img src=x onerror=alert(1)>';
  const program = path.join(folder, evil.replace('/', '') + '.ngc');
  fs.writeFileSync(program, `; ${evil} </script><script>alert(2)</script>\nG21 G90 G17 F500\n(MSG, ${evil})\n` +
    'G1 X10 Z-5\n; <!-- <script> --> ]]>\nG1 X0\nM2\n');
  const tools = path.join(folder, 'tools.toml');
  fs.writeFileSync(tools, `[[tool]]\nnumber = 1\nname = "${evil}"\ndiameter = 10.0\nlength = 60.0\nflute_length = 20.0\n`);
  const page = await open(browser, run(program));
  assert.ok((await page.textContent('h1')).includes(evil));
  assert.equal(await page.locator('img[src=x]').count(), 0);
  assert.ok((await page.textContent('.program')).includes('</script><script>alert(2)</script>'));
  assert.deepEqual(page.problems, []);
};

tests['fits a phone'] = async browser => {
  const page = await open(browser, run('programs/holder-into-vise.ngc'), {width: 390, height: 800});
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, 'nothing hangs over: ' + wide);
  const view = await page.locator('.view').boundingBox();
  assert.ok(view.width > 300 && view.height > 250, JSON.stringify(view));
  await shot(page, 'phone');
  assert.deepEqual(page.problems, []);
};

const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: [...flags, ...software]});
let failed = 0;
async function attempt(name, test) {
  try {
    await test();
    console.log('ok    ' + name);
  } catch (problem) {
    ++failed;
    console.log('FAIL  ' + name + '\n' + problem.stack);
  }
}
for (const [name, test] of Object.entries(tests)) await attempt(name, () => test(browser));
await browser.close();
const blind = await chromium.launch({executablePath: '/usr/bin/chromium', args: [...flags, '--disable-3d-apis']});
await attempt('shows pictures where there is no WebGL', async () => {
  const page = await open(blind, run('programs/holder-into-vise.ngc'));
  assert.match(await page.textContent('#replay'), /No replay in 3D here/);
  assert.ok(await page.locator('#replay img').evaluate(image => image.naturalWidth > 300));
  await shot(page, 'no-webgl');
});
await blind.close();
process.exitCode = failed ? 1 : 0;
