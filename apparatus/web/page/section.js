// The concrete in the section through its axis, with the cone as it is lifted. One concrete fills both sides; of
// two the first stands on the left, the second on the right.

// surface(): plate.js.

/// runs: [{frames, lift [m/s]}], at the time shown; shade(point's numbers, index).
function drawSection(canvas, runs, time, view) {
  const {context, width, height} = prepare(canvas, view.ratio);
  const scale = width / (2 * view.reach), floor = height - 22, middle = width / 2;
  const size = Math.max(1.5, view.ring * scale);
  const sides = runs.length === 1 ? [[runs[0], 1], [runs[0], -1]] : [[runs[0], -1], [runs[1], 1]];
  for (const [run, side] of sides) {
    if (!run.frames.length) continue;
    const across = (r) => middle + side * r * scale, up = (z) => floor - z * scale, frame = frameAt(run.frames, time);
    drawBody(context, frame, view.ring, across, up);
    drawPoints(context, frame, view, across, up, size);
    drawMould(context, mouldOf(run.concrete), run.lift * time, side, middle, floor, scale);
  }
  drawFloor(context, width, floor, middle, scale, view.reach);
  if (runs.length === 2) {
    context.fillStyle = theme("--text");
    context.textAlign = "left", context.fillText(runs[0].label, 6, 14);
    context.textAlign = "right", context.fillText(runs[1].label, width - 6, 14);
  }
}

/// The last frame that is not after the time.
function frameAt(frames, time) {
  let found = frames[0];
  for (const frame of frames)
    if (frame.time <= time + 1e-9) found = frame;
  return found;
}

/// The room that the concrete fills, between its points.
function drawBody(context, {points}, ring, across, up) {
  const tops = surface(points, 1, ring);
  context.fillStyle = theme("--concrete");
  context.beginPath();
  context.moveTo(across(0), up(0));
  tops.forEach((z, k) => context.lineTo(across((k + 0.5) * ring), up(z)));
  context.lineTo(across((tops.length - 0.5) * ring), up(0));
  context.fill();
}

function drawPoints(context, {points}, view, across, up, size) {
  const buckets = Array.from({length: 65}, () => []);
  for (let i = 0; i < points.length; i += 4) buckets[view.shade(points[i + view.at]) + 1].push(i);
  buckets.forEach((bucket, k) => {
    context.fillStyle = colourOf(k - 1);
    for (const i of bucket) context.fillRect(across(points[i]) - size / 2, up(points[i + 1]) - size / 2, size, size);
  });
}

function drawMould(context, {top_radius: top, bottom_radius: bottom, height}, rim, side, middle, floor, scale) {
  context.strokeStyle = theme("--cone");
  context.lineWidth = 3;
  context.beginPath();
  context.moveTo(middle + side * bottom * scale, floor - rim * scale);
  context.lineTo(middle + side * top * scale, floor - (rim + height) * scale);
  context.stroke();
}

function drawFloor(context, width, floor, middle, scale, reach) {
  context.strokeStyle = context.fillStyle = theme("--text");
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(0, floor + 1), context.lineTo(width, floor + 1);
  context.textAlign = "center";
  const step = reach < 0.2 ? 20 : 100, most = step * Math.floor((1000 * reach) / step);
  for (let mm = -most; mm <= most; mm += step) {
    if (Math.abs(mm) / 1000 > reach * 0.97) continue;
    const x = middle + (mm / 1000) * scale;
    context.moveTo(x, floor + 1), context.lineTo(x, floor + 5);
    context.fillText(String(Math.abs(mm)), x, floor + 17);
  }
  context.stroke();
}
