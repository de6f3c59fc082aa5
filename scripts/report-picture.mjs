// A picture of the replay in a report, at its first finding, in Chromium.
// usage: node scripts/report-picture.mjs REPORT.html OUT.png      (after a build: BUILD/web has playwright-core)
import {createRequire} from 'node:module';
import path from 'node:path';

const root = path.resolve(path.dirname(new URL(import.meta.url).pathname), '..');
const {chromium} = createRequire(path.join(root, 'build/release/web/'))('playwright-core');
const [report, out] = process.argv.slice(2).map(p => path.resolve(p));
const browser = await chromium.launch({executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
const page = await browser.newPage({viewport: {width: 1200, height: 820}});
await page.goto('file://' + encodeURI(report));
await page.waitForFunction(() => document.documentElement.dataset.ready === 'yes', null, {timeout: 60000});
await page.click('button.goto');
await page.waitForFunction(() => /line \d/.test(document.querySelector('.status').textContent));
await page.waitForTimeout(2000);
await page.locator('#replay').screenshot({path: out});
await browser.close();
