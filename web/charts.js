// Charts over time (uPlot): feed achieved, and the joints. A click moves the replay there.
import uPlot from 'uplot';

const colors = ['#1e88e5', '#e53935', '#43a047', '#fb8c00', '#8e24aa', '#00897b', '#6d4c41', '#546e7a', '#c0ca33'];
const most = 4000;  // points of a chart: more than it has pixels

// First, lowest, highest and last of each of `most / 4` stretches, so that no peak is lost.
function thinned(times, columns) {
  const n = times.length;
  if (n <= most) return [times, ...columns];
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
  return [times, ...columns].map(column => order.map(i => column[i]));
}

export function charts(host, {run, numbers, make}, seek) {
  const count = run.keys.count;
  if (count < 2) return;
  host.hidden = false;
  host.append(make('h2', {}, 'Charts'));
  const times = numbers(run.keys.t, count);
  const all = [];
  const sync = uPlot.sync('run');
  function chart(title, unit, names, columns) {
    const place = make('div', {class: 'chart'});
    host.append(place);
    const color = () => getComputedStyle(document.documentElement).getPropertyValue('--text').trim();
    const line = () => getComputedStyle(document.documentElement).getPropertyValue('--line').trim();
    const axis = {stroke: color, grid: {stroke: line, width: 1}, ticks: {stroke: line}};
    const plot = new uPlot({
      title, width: place.clientWidth || 800, height: 220, cursor: {sync: {key: sync.key}, drag: {x: true, y: false}},
      scales: {x: {time: false}},
      axes: [{...axis, label: 's'}, {...axis, label: unit, size: 70}],
      series: [{label: 's', value: (_, v) => v === null ? '–' : v.toFixed(2)},
        ...names.map((name, i) => ({label: name, stroke: colors[i % colors.length], width: 1.4,
          value: (_, v) => v === null || v === undefined ? '–' : v.toFixed(3)}))],
    }, thinned(times, columns), place);
    plot.over.addEventListener('click', () => {
      if (plot.cursor.left >= 0) seek(plot.posToVal(plot.cursor.left, 'x'));
    });
    all.push([plot, place]);
  }
  chart('feed achieved', 'mm/min', ['feed'], [numbers(run.keys.feed, count)]);
  for (const unit of ['mm', '°']) {
    const some = run.joints.filter(j => j.unit === unit);
    if (some.length > 0)
      chart(unit === 'mm' ? 'linear joints' : 'rotary joints', unit, some.map(j => j.name), some.map(j => numbers(j.values, count)));
  }
  addEventListener('resize', () => {
    for (const [plot, place] of all) plot.setSize({width: place.clientWidth, height: 220});
  });
  addEventListener('themechange', () => {
    for (const [plot] of all) plot.redraw();
  });
}
