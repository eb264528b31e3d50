// Files and links to take away.

function save(name, blob) {
  const link = element("a", {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const fileName = (run, ending) => `slump_flow_${run.label.toLowerCase().replace(/\W+/g, "_")}.${ending}`;
const saveToml = (run) => save(fileName(run, "toml"), new Blob([tomlOf(run.concrete)], {type: "application/toml"}));
const saveCsv = (run) => save(fileName(run, "csv"), new Blob([run.result.timeseries], {type: "text/csv"}));

/// The values and choices of a concrete, on three lines.
function valuesText({concrete}) {
  const values = fields.filter((field) => field.symbol && counts(field, concrete)).map((field) => `${field.symbol} ${shown(field, concrete)}`);
  const chosen = choices.map(({key, word, options}) => `${word}: ${options[concrete[key]]}`);
  return [values.slice(0, 4), values.slice(4), chosen].map((line) => line.join(", "));
}

/// Answer, values, section, plate and chart on one sheet.
function savePng(runs) {
  const parts = ["section", "plate", "chart"].map(byId), dense = window.devicePixelRatio || 1, margin = 24 * dense;
  const width = Math.max(...parts.map((p) => p.width)) + 2 * margin, line = 26 * dense;
  const sheet = element("canvas");
  sheet.width = width;
  sheet.height = parts.reduce((sum, p) => sum + p.height + margin, (4 * runs.length + 2) * line + margin);
  const context = sheet.getContext("2d");
  context.fillStyle = theme("--panel");
  context.fillRect(0, 0, sheet.width, sheet.height);
  context.fillStyle = theme("--text");
  const write = (text, size) => {
    context.font = `${size * dense}px system-ui, sans-serif`;
    context.fillText(text, margin, y, width - 2 * margin);
    y += line;
  };
  let y = line + margin / 2;
  for (const run of runs) {
    const {results, error} = run.summary, bar = error?.spread_mm ? ` ± ${Math.max(1, Math.ceil(error.spread_mm))}` : "";
    write(`${run.label}: slump flow ${results.spread_mm.toFixed(0)}${bar} mm`, 17);
    valuesText(run).forEach((text) => write(text, 14));
  }
  for (const part of parts) {
    context.drawImage(part, (width - part.width) / 2, y);
    y += part.height + margin;
  }
  write(`Tremie ${byId("version").textContent}, ${new Date().toISOString().slice(0, 10)}; lengths in mm, grey: at rest`, 14);
  sheet.toBlob((blob) => save(fileName(runs[0], "png"), blob));
}

async function copyLink(said) {
  const link = location.href;
  try {
    await navigator.clipboard.writeText(link);
    said.textContent = "The link is on the clipboard.";
  } catch {
    said.textContent = "Copy the address of this page: it holds the values.";
  }
}
