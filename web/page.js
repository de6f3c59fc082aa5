// The page itself, without libraries: reads the run's data, fills head, findings and tables, and
// hands over to the replay and the charts (bundle.js) when they were built in. Text of the inputs
// only ever becomes textContent.
'use strict';
(async () => {
  const run = JSON.parse(document.getElementById('run').textContent);
  const report = run.report;

  // ---- small helpers -------------------------------------------------------------------------
  const by = id => document.getElementById(id);
  function make(tag, properties = {}, ...children) {
    const node = document.createElement(tag);
    for (const [key, value] of Object.entries(properties)) {
      if (key === 'class') node.className = value;
      else if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
      else if (key in node) node[key] = value;
      else node.setAttribute(key, value);
    }
    node.append(...children.filter(child => child !== null && child !== undefined));
    return node;
  }
  const fixed = (value, digits) => value === null || value === undefined ? '–' : value.toFixed(digits);
  function clock(seconds) {
    if (seconds < 60) return seconds.toFixed(1) + ' s';
    const whole = Math.round(seconds), h = Math.floor(whole / 3600), m = Math.floor(whole / 60) % 60;
    const two = n => String(n).padStart(2, '0');
    return (h ? h + ' h ' + two(m) : m) + ' min ' + two(whole % 60) + ' s';
  }
  // A table whose columns are {title, number, of: row → text or node, sort: row → value}.
  function table(columns, rows) {
    const body = make('tbody');
    const fill = list => body.replaceChildren(...list.map(row => make('tr', {},
      ...columns.map(c => make('td', {class: c.number ? 'number' : ''}, c.of(row))))));
    let up = true, last = null;
    const head = make('tr', {}, ...columns.map(c => {
      const cell = make('th', {class: c.number ? 'number' : '', scope: 'col'});
      const key = c.sort || (c.number ? row => parseFloat(c.of(row)) : row => String(c.of(row)));
      cell.append(make('button', {title: 'sort', onclick: () => {
        up = last === c ? !up : true;
        last = c;
        const order = (a, b) => (key(a) > key(b) ? 1 : key(a) < key(b) ? -1 : 0) * (up ? 1 : -1);
        fill([...rows].sort(order));
        for (const other of head.children) other.removeAttribute('aria-sort');
        cell.setAttribute('aria-sort', up ? 'ascending' : 'descending');
      }}, c.title));
      return cell;
    }));
    fill(rows);
    return make('table', {}, make('thead', {}, head), body);
  }

  // ---- packed data (src/page/pack.h) ---------------------------------------------------------
  const packed = Uint8Array.from(atob(by('blob').textContent), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  function integers(row, Kind = Float64Array) {
    const out = new Kind(row.count);
    let at = row.at, before = 0;
    for (let i = 0; i < row.count; ++i) {
      let value = 0, scale = 1, byte;
      do {
        byte = bytes[at++];
        value += (byte & 0x7f) * scale;
        scale *= 128;
      } while (byte & 0x80);
      before += value % 2 ? -(value + 1) / 2 : value / 2;
      out[i] = before;
    }
    return out;
  }
  function numbers(row, count) {
    if ('all' in row) return new Float64Array(count).fill(row.all);
    const out = integers(row);
    for (let i = 0; i < out.length; ++i) out[i] *= row.unit;
    return out;
  }
  const text = row => new TextDecoder().decode(bytes.subarray(row.at, row.at + row.count));
  const data = {run, integers, numbers, text, make, clock, fixed};

  // ---- head ----------------------------------------------------------------------------------
  const words = {pass: 'PASS – nothing found', fail: 'FAIL', unknown: 'UNKNOWN – not everything could be checked'};
  const theme = make('button', {title: 'light or dark', onclick: () => {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === 'dark'
                                    : matchMedia('(prefers-color-scheme: dark)').matches;
    root.dataset.theme = dark ? 'light' : 'dark';
    dispatchEvent(new Event('themechange'));
  }}, '◐ theme');
  const counted = severity => {
    const n = report.findings.filter(f => f.severity === severity).length;
    return n + ' ' + severity + (n === 1 ? '' : 's');
  };
  by('head').append(
    make('span', {class: 'verdict ' + report.verdict}, words[report.verdict]),
    make('h1', {}, run.program.name), theme,
    make('span', {class: 'facts'}, [report.machine, clock(report.timing.cycle_time_s),
      counted('error') + ', ' + counted('warning')].filter(Boolean).join('  ·  ')));
  document.title = report.verdict + ' – ' + run.program.name + ' – aircut';

  // ---- what was not checked ------------------------------------------------------------------
  if (report.unchecked.length > 0) {
    by('unchecked').hidden = false;
    by('unchecked').append(make('h2', {}, 'Not checked'),
      make('ul', {}, ...report.unchecked.map(what => make('li', {}, what))));
  }

  // ---- findings ------------------------------------------------------------------------------
  let player = null;
  const go = finding => {
    if (!player || finding.t_worst_s === undefined) return;
    player.show(finding);
    by('replay').scrollIntoView({behavior: 'smooth', block: 'start'});
  };
  const line = f => f.place ? f.place.line : 0;
  by('findings').append(make('h2', {}, 'Findings'));
  if (report.findings.length === 0) {
    by('findings').append(make('p', {class: 'note'}, 'None.'));
  } else {
    by('findings').append(table([
      {title: 'severity', of: f => make('b', {class: f.severity}, f.severity),
       sort: f => ['error', 'warning', 'info'].indexOf(f.severity)},
      {title: 'kind', of: f => f.kind},
      {title: 'line', number: true, of: f => line(f) ? String(line(f)) : '–', sort: line},
      {title: 'time', number: true, of: f => f.t_worst_s === undefined ? '–' : fixed(f.t_worst_s, 2) + ' s',
       sort: f => f.t_worst_s ?? -1},
      {title: 'what', sort: f => f.message, of: f => make('div', {}, f.message,
        f.place && f.place.block ? make('div', {class: 'code'}, f.place.block) : null,
        f.remedy ? make('div', {class: 'note'}, f.remedy) : null,
        ...(f.notes || []).map(n => make('div', {class: 'note'}, n.label + ': ' + n.text)),
        f.joints_worst ? make('div', {class: 'note code'}, Object.entries(f.joints_worst)
          .map(([name, value]) => name.replace(/_(mm|deg)$/, '') + ' ' + fixed(value, 3)).join('  ')) : null,
        f.t_worst_s !== undefined
          ? make('button', {class: 'goto', onclick: () => go(f)}, 'show in the replay') : null)},
      {title: 'picture', sort: f => f.picture || '', of: f => f.picture && run.pictures[f.picture]
        ? make('img', {src: run.pictures[f.picture], alt: f.message})
        : f.picture ? make('span', {class: 'note'}, f.picture) : ''},
    ], report.findings));
    if (report.findings_left_out > 0)
      by('findings').append(make('p', {class: 'note'}, 'and ' + report.findings_left_out + ' more, in result.json'));
  }

  // ---- tables --------------------------------------------------------------------------------
  by('axes').append(make('h2', {}, 'Axes'), table([
    {title: 'axis', of: j => j.name},
    {title: 'from', number: true, of: j => fixed(j.low, 3) + ' ' + j.unit, sort: j => j.low},
    {title: 'to', number: true, of: j => fixed(j.high, 3) + ' ' + j.unit, sort: j => j.high},
    {title: 'limits', number: true, of: j => fixed(j.min, 1) + ' … ' + fixed(j.max, 1), sort: j => j.min},
    {title: 'travel used', of: j => {
      if (j.min === null || j.max === null || !(j.max > j.min)) return '';
      const share = v => 100 * Math.min(1, Math.max(0, (v - j.min) / (j.max - j.min)));
      const bar = make('div', {class: 'bar', role: 'img', 'aria-label': fixed(share(j.low), 0) + ' to ' + fixed(share(j.high), 0) + ' percent'}, make('i'));
      bar.firstChild.style.left = share(j.low) + '%';
      bar.firstChild.style.width = share(j.high) - share(j.low) + '%';
      return bar;
    }, sort: j => j.high - j.low},
    {title: 'distance', number: true, of: j => fixed(j.distance, 1) + ' ' + j.unit, sort: j => j.distance},
    {title: 'reversals', number: true, of: j => String(j.reversals)},
  ], run.joints));
  by('tools').append(make('h2', {}, 'Tools'), table([
    {title: 'tool', number: true, of: t => t.number ? 'T' + t.number : 'none', sort: t => t.number},
    {title: 'name', of: t => t.name},
    {title: 'at the feed', number: true, of: t => clock(t.feed_s), sort: t => t.feed_s},
    {title: 'rapid', number: true, of: t => clock(t.rapid_s), sort: t => t.rapid_s},
    {title: 'way at the feed', number: true, of: t => fixed(t.feed_mm, 0) + ' mm', sort: t => t.feed_mm},
    {title: 'highest feed', number: true, of: t => fixed(t.max_feed_mm_per_min, 0) + ' mm/min', sort: t => t.max_feed_mm_per_min},
    {title: 'highest speed', number: true, of: t => fixed(t.max_rpm, 0) + ' /min', sort: t => t.max_rpm},
    {title: 'lines', number: true, of: t => t.first_line + ' … ' + t.last_line, sort: t => t.first_line},
  ], run.tools.uses));
  const labels = {cycle_time_s: 'cycle time', feed_s: 'at the feed', rapid_s: 'rapid',
    dwell_s: 'dwell', tool_change_s: 'tool changes', spindle_wait_s: 'waiting for the spindle'};
  const times = Object.entries(labels)
    .map(([key, label]) => ({label, seconds: report.timing[key]}))
    .filter(row => typeof row.seconds === 'number');
  by('time').append(make('h2', {}, 'Time'), table([
    {title: 'what', of: t => t.label},
    {title: 'time', number: true, of: t => clock(t.seconds), sort: t => t.seconds},
  ], times));
  const operations = report.timing.operations || [];
  if (operations.length > 1)
    by('time').append(table([
      {title: 'operation', of: o => o.name || 'line ' + o.line},
      {title: 'line', number: true, of: o => String(o.line), sort: o => o.line},
      {title: 'tool', number: true, of: o => o.tool ? 'T' + o.tool : 'none', sort: o => o.tool},
      {title: 'time', number: true, of: o => clock(o.time_s), sort: o => o.time_s},
      {title: 'at the feed', number: true, of: o => clock(o.feed_s), sort: o => o.feed_s},
      {title: 'rapid', number: true, of: o => clock(o.rapid_s), sort: o => o.rapid_s},
      {title: 'tool changes', number: true, of: o => clock(o.tool_change_s), sort: o => o.tool_change_s},
    ], operations));
  if (report.stock) {
    by('stock').hidden = false;
    by('stock').append(make('h2', {}, 'Stock'), make('p', {}, 'removed ' +
      fixed(report.stock.removed_mm3 / 1000, 2) + ' cm³ of ' + fixed(report.stock.initial_mm3 / 1000, 2) +
      ' cm³; what is left is in part.stl (grid ' + fixed(report.stock.pitch_mm, 3) + ' mm)'));
  }
  if (report.accuracy) {
    const host = by('accuracy'), found = report.accuracy;
    host.hidden = false;
    const um = value => fixed(value, 1) + ' µm';
    const at = item => item.line ? ' (line ' + item.line + ')' : '';
    host.append(make('h2', {}, 'Accuracy'), make('p', {}, 'Verdict: ' + found.verdict + '. ' + found.stretches +
      ' stretches, ' + fixed(found.time_s, 1) + ' s in the material. Forces: ' + found.sources.join('; ')));
    if (found.tools.length)
      host.append(table([
        {title: 'tool', number: true, of: t => 'T' + t.tool, sort: t => t.tool},
        {title: 'in the material', number: true, of: t => clock(t.time_s), sort: t => t.time_s},
        {title: 'force', number: true, of: t => fixed(t.F_cut_N.value, 0) + ' N' + at(t.F_cut_N), sort: t => t.F_cut_N.value},
        {title: 'power', number: true, of: t => fixed(t.power_kW.value, 2) + ' kW', sort: t => t.power_kW.value},
        {title: 'surface off by', number: true, of: t => um(t.delta_min_um.value) + ' … ' + um(t.delta_max_um.value) + at(t.delta_max_um), sort: t => t.delta_max_um.value},
        {title: 'mean', number: true, of: t => um(t.delta_mean_um), sort: t => t.delta_mean_um},
        {title: 'shares of the bodies', of: t => t.split.map(s => s.body + ' ' + um(s.delta_mean_um)).join(', ')},
      ], found.tools));
    if (found.dimensions.length)
      host.append(table([
        {title: 'size', of: d => d.name},
        {title: 'error', number: true, of: d => d.unchecked ? 'not known: ' + d.unchecked : um(d.error_min_um) + ' … ' + um(d.error_max_um)},
        {title: 'over a batch', number: true, of: d => d.scatter ? um(d.scatter.low_um) + ' … ' + um(d.scatter.high_um) : ''},
        {title: 'tolerance', number: true, of: d => d.tolerance_um ? um(d.tolerance_um[0]) + ' … ' + um(d.tolerance_um[1]) : 'none'},
        {title: 'fits', of: d => d.fits === undefined ? '' : d.fits ? 'yes' : 'no'},
      ], found.dimensions));
    for (const [name, title] of [['accuracy-time.png', 'Error over time'], ['accuracy-path.png', 'Error over the cut path'],
      ['accuracy-part.png', 'Predicted error on the part']])
      if (run.pictures[name]) host.append(make('img', {src: run.pictures[name], alt: title, class: 'sheet'}));
  }
  by('inputs').append(make('h2', {}, 'Inputs'), table([
    {title: 'what', of: i => i.role}, {title: 'file', of: i => make('code', {}, i.path)},
    {title: 'SHA-256', of: i => make('code', {}, i.sha256 || '')},
  ], report.inputs), make('p', {class: 'note'}, 'aircut ' + report.aircut + '; checks: ' + report.checks.join(', ') + '; ' +
    Object.entries(report.settings).map(([key, value]) => key + ' ' + value).join(', ')));

  // ---- replay and charts ---------------------------------------------------------------------
  const host = by('replay');
  host.append(make('h2', {}, 'Replay'));
  const pictures = why => {
    host.append(make('p', {class: 'note'}, why));
    if (run.pictures['sheet.png'])
      host.append(make('img', {src: run.pictures['sheet.png'], alt: 'pictures of the run', class: 'sheet'}));
  };
  if (!globalThis.aircutPage) {
    pictures('This aircut was built without npm, so the page carries pictures instead of a replay in 3D.');
  } else {
    try {
      player = globalThis.aircutPage.replay(host, data);
    } catch (problem) {
      pictures('No replay in 3D here: ' + problem.message);
    }
    globalThis.aircutPage.charts(by('charts'), data, t => player && player.seek(t));
  }
  document.documentElement.dataset.ready = 'yes';
})();
