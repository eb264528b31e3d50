// Colours: viridis, which colour-blind readers and grey printers can tell apart, and the page's own by CSS.

const viridis = [
  "#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"
].map((hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)));

/// "rgb(…)" for a share from 0 to 1, in 64 steps.
const shades = Array.from({length: 64}, (_, i) => {
  const at = (i / 63) * (viridis.length - 1), k = Math.min(Math.floor(at), viridis.length - 2);
  const mixed = viridis[k].map((a, j) => Math.round(a + (at - k) * (viridis[k + 1][j] - a)));
  return `rgb(${mixed.join(" ")})`;
});

const theme = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/// What the concrete may be coloured by: place of the number in a point and ends of the scale. Concrete that is sheared
/// less than the scale's low end is as good as at rest, and grey.
const quantities = {
  rate: {at: 2, word: "shear rate / (1/s)", range: () => [0.01, 10], log: true},
  lambda: {at: 3, word: "flocculation λ", range: (frames) => [0, Math.max(0.01, highest(frames, 3))], log: false},
};

function highest(frames, at) {
  let most = 0;
  for (const {points} of frames)
    for (let i = at; i < points.length; i += 4)
      if (points[i] > most) most = points[i];
  return most;
}

/// A function from a point's number to its shade, 0 to 63; -1 for grey.
function shadeBy(quantity, [low, high]) {
  const scale =
      quantity.log ? (x) => Math.log(Math.max(x, low) / low) / Math.log(high / low) : (x) => (x - low) / (high - low);
  return (x) => (quantity.log && x < low ? -1 : Math.max(0, Math.min(63, Math.floor(64 * scale(x)))));
}

const colourOf = (shade) => (shade < 0 ? theme("--concrete") : shades[shade]);

/// A canvas made sharp for the screen and as wide as its box; returns its context in CSS pixels, width and height.
function prepare(canvas, ratio) {
  const width = canvas.clientWidth, height = Math.round(width * ratio), dense = window.devicePixelRatio || 1;
  canvas.style.height = `${height}px`;
  if (canvas.width !== Math.round(width * dense) || canvas.height !== Math.round(height * dense)) {
    canvas.width = Math.round(width * dense);
    canvas.height = Math.round(height * dense);
  }
  const context = canvas.getContext("2d");
  context.setTransform(dense, 0, 0, dense, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = "12px system-ui, sans-serif";
  return {context, width, height};
}
