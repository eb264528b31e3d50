// A concrete as the fields hold it, and as a scene: TOML, and the fragment of a link.

const mixes = JSON.parse(byId("mixes").textContent);

/// The fields: key, symbol, unit, limits of the slider, and how it goes into the scene.
const fields = [
  {key: "yield_stress", word: "yield stress", symbol: "τ₀", unit: "Pa", low: 5, high: 500, log: true, least: 0},
  {
    key: "plastic_viscosity",
    word: "plastic viscosity",
    symbol: "μ",
    unit: "Pa.s",
    low: 5,
    high: 200,
    log: true,
    above: 0
  },
  {key: "density", word: "density", symbol: "ρ", unit: "kg/m3", low: 1800, high: 2800, least: 500, most: 5000},
  {key: "rest", word: "rest before the lift", symbol: "t", unit: "s", low: 0, high: 1200, least: 0},
  {key: "structuration_rate", word: "structuration rate", symbol: "A_thix", unit: "Pa/s", low: 0, high: 5, least: 0},
  {key: "breakdown_rate", word: "breakdown rate", symbol: "k", unit: "1/s", low: 0.01, high: 10, log: true, least: 0},
  {key: "rate_exponent", word: "rate exponent", symbol: "a", unit: "", low: 0, high: 1, least: 0, most: 1},
  {
    key: "lift",
    word: "lift of the cone",
    symbol: "v",
    unit: "cm/s",
    low: 0.5,
    high: 50,
    log: true,
    least: 0.5,
    why: " cm/s; slower lifts are beyond what is verified"
  },
  {key: "duration", word: "time of the test, at most", symbol: "", unit: "s", low: 5, high: 300, log: true, above: 0},
];
const unitShown = {
  "Pa.s": "Pa·s",
  "kg/m3": "kg/m³"
};

/// The concrete of a bundled mix.
function concreteOf(name) {
  const mix = mixes[name];
  return {
    mix: name,
    yield_stress: mix.yield_stress,
    plastic_viscosity: mix.plastic_viscosity,
    density: mix.density ?? 2400,
    rest: 0,
    structuration_rate: mix.structuration_rate,
    breakdown_rate: mix.breakdown_rate,
    rate_exponent: mix.rate_exponent,
    lift: 15,
    duration: 30
  };
}

/// A concrete's value with its unit.
const shown = (field, concrete) => `${concrete[field.key]} ${unitShown[field.unit] ?? field.unit}`.trim();

/// Why a value cannot be run; "" where it can.
function wrong(field, value) {
  if (!Number.isFinite(value)) return `${field.word}: write a number${field.unit && ` in ${unitShown[field.unit] ?? field.unit}`}, like ${written(field.low)}`;
  if (value > field.most) return `${field.word}: must be at most ${field.most}`;
  if (field.above !== undefined && value <= field.above) return `${field.word}: must be above ${field.above}`;
  if (field.least !== undefined && value < field.least) return `${field.word}: must be at least ${field.least}${field.why ?? ""}`;
  return "";
}

/// Why values cannot be run beside each other; "" where they can.
function wrongTogether({yield_stress, structuration_rate}) {
  if (yield_stress > 0 || structuration_rate === 0) return "";
  return "yield stress: 0 takes a structuration rate of 0, since rest builds up by A_thix/τ₀";
}

/// The bundled mix whose values the concrete has, whatever its rest and lift; "" for one of its own.
function mixOf(concrete) {
  const own = ["yield_stress", "plastic_viscosity", "density", "structuration_rate", "breakdown_rate", "rate_exponent"];
  return Object.keys(mixes).find((name) => own.every((key) => concreteOf(name)[key] === concrete[key])) ?? "";
}

function nameOf(concrete) {
  const name = mixOf(concrete);
  return name ? mixes[name].name : "your mix";
}

/// What tells the concretes of a picture apart.
function labelsOf(concretes) {
  const labels = concretes.map((c) => nameOf(c) + (c.rest > 0 ? `, ${written(c.rest)} s of rest` : ""));
  return labels.map(
      (label, i) => (labels.indexOf(label) === labels.lastIndexOf(label) ? label : `${label} (${i + 1})`));
}

/// The scene's lines on the mix: the name of a bundled one, which brings what was measured on it, or the values.
function mixLines(c) {
  if (mixOf(c)) return [`mix = "${mixOf(c)}"`];
  const lines = [""];
  lines.push("[mix]", `density           = "${c.density} kg/m3"`, `yield_stress      = "${c.yield_stress} Pa"`);
  lines.push(`plastic_viscosity = "${c.plastic_viscosity} Pa.s"`);
  if (c.structuration_rate > 0) {
    lines.push("", "[mix.thixotropy]", `structuration_rate = "${c.structuration_rate} Pa/s"`);
    lines.push(`breakdown_rate     = "${c.breakdown_rate} 1/s"`, `rate_exponent      = ${c.rate_exponent}`);
  }
  return lines;
}

/// The scene that `tremie run` takes.
function tomlOf(c) {
  const lines = [`# ${nameOf(c)}: slump flow after ${c.rest} s of rest.`, 'apparatus = "slump_flow"', ...mixLines(c), ""];
  lines.push("[test]", `rest       = "${c.rest} s"`, `lift_speed = "${c.lift} cm/s"`, `duration   = "${c.duration} s"`);
  return lines.join("\n") + "\n";
}

/// "yield_stress=54&…" for each concrete, the second one's keys with a 2.
function fragmentOf(concretes) {
  const parts = new URLSearchParams();
  concretes.forEach((c, i) => fields.forEach((f) => parts.set(f.key + (i ? "2" : ""), c[f.key])));
  return parts.toString();
}

/// {concretes, unread} of a fragment. No concretes where it holds none; Mix A's values where it gives none that can be
/// run. `unread`: a text for each entry that was not taken.
function readFragment(fragment) {
  const concretes = {}, unread = [];
  for (const [name, text] of new URLSearchParams(fragment)) {
    const suffix = name.endsWith("2") ? "2" : "", field = fields.find((f) => f.key + suffix === name);
    const concrete = field && (concretes[suffix] ??= concreteOf("mix_a"));
    const value = readNumber(text), fault = field ? wrong(field, value) : "no field has this name";
    if (!fault)
      concrete[field.key] = value;
    else
      unread.push(`${name}=${text} (${fault}${field ? `; ${shown(field, concrete)} stands in its place` : ""})`);
  }
  return {concretes: ["", "2"].filter((suffix) => suffix in concretes).map((suffix) => concretes[suffix]), unread};
}

const tomlValue = (value) => Array.isArray(value) ? `[${value.map(tomlValue).join(", ")}]` : JSON.stringify(value);

/// An object of a scene's keys as TOML and overrides: {mix: "mix_a", test: {rest: "240 s"}, "mix.density": "2350 kg/m3"}.
function sceneText(scene) {
  if (typeof scene === "string") return {toml: scene, overrides: ""};
  if (scene === null || typeof scene !== "object") throw new TypeError("a scene is TOML text or an object of its keys");
  const overrides = [];
  const table = (object, place) => {
    const own = [], below = [];
    for (const [key, value] of Object.entries(object)) {
      if (value === undefined || value === null) continue;
      const path = place ? `${place}.${key}` : key;
      if (key.includes("."))
        overrides.push(`${path}=${typeof value === "string" ? value : tomlValue(value)}`);
      else if (typeof value === "object" && !Array.isArray(value))
        below.push(`[${path}]`, ...table(value, path));
      else
        own.push(`${key} = ${tomlValue(value)}`);
    }
    return [...own, ...below];
  };
  const toml = table({apparatus: "slump_flow", ...scene}, "").join("\n") + "\n";
  return {toml, overrides: overrides.join("\n")};
}
