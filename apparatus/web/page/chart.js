// Spread over time, with the circle of 500 mm, the range of tremie concrete and what was measured.

const tremieRange = [450, 650];

/// [low, high, step] of the spread's axis [mm].
function spreadAxis(runs) {
  const most = Math.max(...runs.map((run) => run.spread.at(-1) ?? 0)), foot = Math.min(...runs.map(footOf));
  if (runs.some(hasClasses)) return [Math.min(200, foot), 100 * Math.ceil((Math.max(680, most) + 20) / 100), 100];
  const step = most - foot > 150 ? 50 : 20, low = step * Math.floor(foot / step);
  return [low, step * Math.ceil((Math.max(most, low + 4 * step) + step / 4) / step), step];
}

function drawChart(canvas, runs, time) {
  const {context, width, height} = prepare(canvas, canvas.clientWidth < 500 ? 0.75 : 0.5);
  const legendHeight = runs.length === 2 ? 36 : 0;  // above the curves, so that it never covers one
  const box = {left: 46, right: width - 12, top: 12 + legendHeight, bottom: height - 40};
  const last = Math.max(1, ...runs.map((run) => run.time.at(-1) ?? 0));
  if (!runs.length) return;
  const axis = spreadAxis(runs), [low, most] = axis;
  const x = (t) => box.left + ((box.right - box.left) * t) / last;
  const y = (mm) => box.bottom - ((box.bottom - box.top) * (mm - low)) / (most - low);
  const classes = runs.some(hasClasses);
  if (classes) band(context, box, y(tremieRange[0]), y(tremieRange[1]), theme("--band"), "tremie concrete, 450 to 650 mm");
  axes(context, box, x, y, last, axis);
  if (classes) line(context, [[box.left, y(500)], [box.right, y(500)]], theme("--text"), 1, [6, 4]);
  runs.forEach((run, i) => drawMeasured(context, box.right - 10 - 16 * i, y, run, runs.length === 2));
  for (const run of runs) {
    line(context, run.time.map((t, i) => [x(t), y(run.spread[i])]), run.colour, 2.5, run.dash);
    const t500 = run.summary?.results.t500_s;
    if (t500 != null) dot(context, x(t500), y(500), run.colour);
    if (run.time.length && time <= last)
      dot(context, x(Math.min(time, run.time.at(-1))), y(spreadAt(run, time)), run.colour, true);
  }
  if (legendHeight) legend(context, runs, box.left);
}

function band(context, box, low, high, colour, text) {
  context.fillStyle = colour;
  context.fillRect(box.left, high, box.right - box.left, low - high);
  context.fillStyle = theme("--muted");
  context.textAlign = "right";
  context.fillText(text, box.right - 6, low - 6);
}

function axes(context, box, x, y, last, [low, most, rise]) {
  context.fillStyle = theme("--muted");
  context.textAlign = "right";
  for (let mm = low; mm <= most; mm += rise) {
    line(context, [[box.left, y(mm)], [box.right, y(mm)]], theme("--grid"), 1);
    context.fillText(String(mm), box.left - 6, y(mm) + 4);
  }
  context.textAlign = "center";
  const step = [0.2, 0.5, 1, 2, 5, 10, 20].find((s) => last / s <= 8) ?? 50;
  for (let t = 0; t <= last; t += step) context.fillText(written(t, 2), x(t), box.bottom + 16);
  context.fillText("time since the start of the lift / s", (box.left + box.right) / 2, box.bottom + 33);
  context.save();
  context.translate(12, (box.top + box.bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.fillText("spread / mm", 0, 0);
  context.restore();
}

function line(context, points, colour, width, dash = []) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dash);
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
  context.stroke();
  context.setLineDash([]);
}

function dot(context, x, y, colour, open = false) {
  context.fillStyle = open ? theme("--panel") : colour;
  context.strokeStyle = colour;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, y, 4.5, 0, 2 * Math.PI);
  context.fill();
  context.stroke();
}

/// The measured spread and its tolerance as a bar at the end of the time; one of two in its run's colour, named in the
/// legend.
function drawMeasured(context, x, y, run, ofTwo) {
  const measured = measuredOn(run.concrete), colour = ofTwo ? run.colour : theme("--measured");
  if (!measured) return;
  const {value, tolerance} = measured;
  line(context, [[x, y(value - tolerance)], [x, y(value + tolerance)]], colour, 2);
  for (const mm of [value - tolerance, value + tolerance])
    line(context, [[x - 5, y(mm)], [x + 5, y(mm)]], colour, 2);
  dot(context, x, y(value), colour);
  if (ofTwo) return;
  context.fillStyle = colour;
  context.textAlign = "right";
  context.fillText("measured", x - 10, y(value) + 4);
}

function legend(context, runs, x) {
  context.textAlign = "left";
  runs.forEach((run, i) => {
    const y = 16 + 16 * i;
    line(context, [[x, y - 4], [x + 26, y - 4]], run.colour, 2.5, run.dash);
    context.fillStyle = theme("--text");
    const measured = measuredOn(run.concrete);
    const bar = measured ? `; bar: measured ${measured.value} ± ${measured.tolerance} mm` : "";
    context.fillText(run.label + bar, x + 32, y);
  });
}
