// Charts (uPlot) over time or over the lines of the program: feed achieved, joints, what they are
// asked for against their limits, material removed. A click moves the replay there.
import uPlot from 'uplot';

const colors = ['#1e88e5', '#e53935', '#43a047', '#fb8c00', '#8e24aa', '#00897b', '#6d4c41', '#546e7a', '#c0ca33'];
const most = 4000;  // points of a chart: more than it has pixels
const quantities = [['speed', 'speed of the joints'], ['acceleration', 'acceleration of the joints'], ['jerk', 'jerk of the joints']];

// First, lowest, highest and last of each of `most / 4` stretches, so that no peak is lost.
function thinned([xs, ...columns]) {
  const n = xs.length;
  if (n <= most) return [xs, ...columns];
  const keep = new Set([0, n - 1]);
  const stretch = Math.ceil(n / (most / 4 / columns.length));
  for (const column of columns)
    for (let from = 0; from < n; from += stretch) {
      let low = from, high = from;
      for (let i = from; i < Math.min(n, from + stretch); ++i) {
        if (column[i] < column[low]) low = i;
        if (column[i] > column[high]) high = i;
      }
      keep.add(from).add(low).add(high);
    }
  const order = [...keep].sort((a, b) => a - b);
  return [xs, ...columns].map(column => order.map(i => column[i]));
}

// Lowest and highest of each column while a line of the program was at work. Between moments the
// columns are linear; with a width they are steps.
function byLine({times, columns, width}, blocks) {
  const found = new Map();
  let k = 0;
  const end = width ? times.length * width : times[times.length - 1];
  for (let b = 0; b < blocks.t.length; ++b) {
    const line = blocks.line[b];
    const from = blocks.t[b], to = b + 1 < blocks.t.length ? blocks.t[b + 1] : end;
    if (!line || to <= from) continue;
    let row = found.get(line);
    if (!row) found.set(line, row = columns.map(() => [Infinity, -Infinity]));
    const note = (c, v) => {
      if (v < row[c][0]) row[c][0] = v;
      if (v > row[c][1]) row[c][1] = v;
    };
    if (width) {
      columns.forEach((_, c) => note(c, 0));  // what is not in the list any more is at rest
      for (let i = Math.floor(from / width); i < times.length && i * width < to; ++i)
        columns.forEach((column, c) => note(c, column[i]));
      continue;
    }
    while (k + 1 < times.length && times[k + 1] <= from) ++k;
    const at = (column, i, t) => {
      if (i + 1 >= times.length) return column[i];
      const span = times[i + 1] - times[i];
      return span > 0 ? column[i] + (column[i + 1] - column[i]) * Math.min(1, (t - times[i]) / span) : column[i];
    };
    let last = k;
    columns.forEach((column, c) => note(c, at(column, k, from)));
    for (let i = k + 1; i < times.length && times[i] < to; ++i) {
      columns.forEach((column, c) => note(c, column[i]));
      last = i;
    }
    columns.forEach((column, c) => note(c, at(column, last, to)));
  }
  const lines = [...found.keys()].sort((a, b) => a - b);
  return {lines, low: columns.map((_, c) => lines.map(l => found.get(l)[c][0])),
    high: columns.map((_, c) => lines.map(l => found.get(l)[c][1]))};
}

// What can be drawn: rows over the replay's moments, or with a width over equal stretches of time.
function curves({run, numbers}) {
  const count = run.keys.count;
  const times = numbers(run.keys.t, count);
  const out = [{title: 'feed achieved', unit: 'mm/min', names: ['feed'], times, columns: [numbers(run.keys.feed, count)]}];
  if (run.removal) {
    const {width, count: steps, values} = run.removal;
    out.push({title: 'material removed', unit: 'cm³/min', names: ['rate'], width, columns: [numbers(values, steps)]});
  }
  for (const unit of ['mm', '°']) {
    const some = run.joints.filter(j => j.unit === unit);
    if (some.length > 0)
      out.push({title: unit === 'mm' ? 'linear joints' : 'rotary joints', unit, names: some.map(j => j.name), times,
        columns: some.map(j => numbers(j.values, count))});
  }
  const {width, count: steps} = run.rates;
  for (const [quantity, title] of quantities) {
    const some = run.rates[quantity];
    if (some.length > 0 && steps > 1)
      out.push({title, unit: '% of the limit', limit: 100, names: some.map(j => j.name), width,
        columns: some.map(j => numbers(j.values, steps))});
  }
  const end = times[times.length - 1];
  for (const curve of out) {
    if (!curve.width) continue;
    const steps = Math.max(curve.columns[0].length, Math.ceil(end / curve.width));  // at rest at the end
    curve.columns = curve.columns.map(column => Float64Array.from({length: steps}, (_, i) => column[i] ?? 0));
    curve.times = Float64Array.from({length: steps}, (_, i) => i * curve.width);
  }
  return out;
}

export function charts(host, data, seek) {
  const {run, numbers, make} = data;
  if (run.keys.count < 2) return;
  host.hidden = false;
  const choice = make('select', {'aria-label': 'what the charts are over'},
    make('option', {value: 'time'}, 'over time'), make('option', {value: 'line'}, 'over the lines of the program'));
  host.append(make('h2', {}, 'Charts'), make('p', {}, choice));
  const blocks = {t: numbers(run.blocks.t, run.blocks.count), line: numbers(run.blocks.line, run.blocks.count)};
  const all = curves(data);
  let drawn = [];

  const style = name => () => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const axis = {stroke: style('--text'), grid: {stroke: style('--line'), width: 1}, ticks: {stroke: style('--line')}};
  const value = digits => (_, v) => v === null || v === undefined ? '–' : v.toFixed(digits);
  const stepped = uPlot.paths.stepped({align: 1});

  function draw(curve, place, key, lines) {
    const series = [], columns = [];
    curve.names.forEach((name, i) => {
      const stroke = colors[i % colors.length];
      if (lines) {
        const look = {stroke, value: value(3), paths: stepped, points: {show: false}};
        series.push({...look, label: name + ' most', width: 1.4});
        columns.push(lines.high[i]);
        if (curve.width) return;
        series.push({...look, label: name + ' least', width: 0.8, dash: [3, 3]});
        columns.push(lines.low[i]);
      } else {
        series.push({label: name, stroke, width: 1.4, value: value(3), ...(curve.width ? {paths: stepped} : {})});
        columns.push(curve.columns[i]);
      }
    });
    const xs = lines ? lines.lines : curve.times;
    if (curve.limit) {
      series.push({label: 'limit', stroke: '#e53935', width: 1, dash: [8, 4], points: {show: false}, value: value(0)});
      columns.push(Array.from(xs, () => curve.limit));
    }
    const plot = new uPlot({
      title: curve.title, width: place.clientWidth || 800, height: 220,
      cursor: {sync: {key}, drag: {x: true, y: false}}, scales: {x: {time: false}},
      axes: [{...axis, label: lines ? 'line' : 's'}, {...axis, label: curve.unit, size: 70}],
      series: [{label: lines ? 'line' : 's', value: value(lines ? 0 : 2)}, ...series],
    }, thinned([xs, ...columns]), place);
    plot.over.addEventListener('click', () => {
      if (plot.cursor.left < 0) return;
      const x = plot.posToVal(plot.cursor.left, 'x');
      if (!lines) return seek(x);
      const line = xs[nearest(xs, x)];
      seek(blocks.t[blocks.line.indexOf(line)]);
    });
    drawn.push([plot, place]);
  }
  const nearest = (xs, x) => {
    let best = 0;
    for (let i = 1; i < xs.length; ++i)
      if (Math.abs(xs[i] - x) < Math.abs(xs[best] - x)) best = i;
    return best;
  };
  function show() {
    for (const [plot, place] of drawn) {
      plot.destroy();
      place.remove();
    }
    drawn = [];
    const over = choice.value, key = uPlot.sync(over).key;
    for (const curve of all) {
      const lines = over === 'line' ? byLine(curve, blocks) : null;
      if (lines && lines.lines.length < 2) continue;
      const place = make('div', {class: 'chart'});
      host.append(place);
      draw(curve, place, key, lines);
    }
  }
  show();
  choice.addEventListener('change', show);
  addEventListener('resize', () => {
    for (const [plot, place] of drawn) plot.setSize({width: place.clientWidth, height: 220});
  });
  addEventListener('themechange', () => {
    for (const [plot] of drawn) plot.redraw();
  });
}
