// The concrete on the plate, seen from above, with the mould's foot and the circle of 500 mm.

/// Rings of width `ring` [m]: the number of the highest point, which the eye sees from above. A ring without points has
/// the one before it.
function surface(points, at, ring) {
  const rings = [], heights = [];
  for (let i = 0; i < points.length; i += 4) {
    const k = Math.floor(points[i] / ring);
    if (heights[k] === undefined || points[i + 1] > heights[k])
      (heights[k] = points[i + 1]), (rings[k] = points[i + at]);
  }
  for (let k = 0; k < rings.length; k++) rings[k] ??= rings[k - 1] ?? rings.find((x) => x !== undefined);
  return rings;
}

function drawPlate(canvas, runs, time, view) {
  const {context, width, height} = prepare(canvas, 1);
  const scale = width / (2 * view.reach), x = width / 2, y = height / 2;
  context.fillStyle = theme("--plate");
  context.fillRect(0, 0, width, height);
  runs.forEach((run, i) => {
    if (!run.frames.length) return;
    context.save();
    if (runs.length === 2) {
      context.beginPath();
      context.rect(i ? x : 0, 0, x, height);
      context.clip();
    }
    const radius = spreadAt(run, time) / 2000;
    fillDisc(context, surface(frameAt(run.frames, time).points, view.at, view.ring), radius, view, x, y, scale);
    context.restore();
  });
  if (runs.length === 2)
    runs.forEach((run) => circle(context, x, y, (spreadAt(run, time) / 2000) * scale, run.colour, [], 2));
  for (const run of runs) circle(context, x, y, mouldOf(run.concrete).bottom_radius * scale, theme("--text"), [2, 3], 1.5);
  if (!runs.some(hasClasses)) return;
  circle(context, x, y, 0.25 * scale, theme("--plate"), [], 4);
  circle(context, x, y, 0.25 * scale, theme("--text"), [7, 5], 1.5);
  label(context, "500 mm", x, y - 0.25 * scale - 6);
}

/// Rings from the outside in, each in the colour of its surface.
function fillDisc(context, rings, radius, view, x, y, scale) {
  const {ring} = view;
  for (let k = Math.ceil(radius / ring) - 1; k >= 0; k--) {
    context.fillStyle = colourOf(view.shade(rings[Math.min(k, rings.length - 1)]));
    context.beginPath();
    context.arc(x, y, Math.min((k + 1) * ring, radius) * scale, 0, 2 * Math.PI);
    context.fill();
  }
}

function circle(context, x, y, radius, colour, dash, width) {
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.setLineDash(dash);
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.stroke();
  context.setLineDash([]);
}

/// Text on a ground of its own, to be read on any colour.
function label(context, text, x, y) {
  const half = context.measureText(text).width / 2 + 4;
  context.fillStyle = theme("--plate");
  context.fillRect(x - half, y - 11, 2 * half, 15);
  context.fillStyle = theme("--text");
  context.textAlign = "center";
  context.fillText(text, x, y);
}
