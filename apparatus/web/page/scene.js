// A concrete as the fields hold it, and as a scene: TOML, and the fragment of a link.

const mixes = JSON.parse(byId("mixes").textContent);
const moulds = JSON.parse(byId("moulds").textContent);  // lengths in m

/// What is chosen by word: key, word, and the options' values with their names.
const choices = [
  {key: "mould", word: "mould", options: Object.fromEntries(Object.entries(moulds).map(([name, mould]) => [name, mould.name]))},
  {
    key: "kinetics",
    word: "breakdown",
    options: {rate_power: "by time", gated: "by strain, above 0.1 1/s", roussel: "by strain"}
  },
  {
    key: "floor",
    word: "floor",
    options: {no_slip: "holds the concrete", interface: "a layer slides", friction: "friction"}
  },
];

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
  {
    key: "breakdown_rate",
    word: "breakdown rate",
    symbol: "k",
    unit: "1/s",
    low: 0.01,
    high: 10,
    log: true,
    least: 0,
    only: {kinetics: ["rate_power"]}
  },
  {
    key: "rate_exponent",
    word: "rate exponent",
    symbol: "a",
    unit: "",
    low: 0,
    high: 1,
    least: 0,
    most: 1,
    only: {kinetics: ["rate_power"]}
  },
  {
    key: "destructuration",
    word: "destructuration",
    symbol: "α",
    unit: "",
    low: 0.001,
    high: 10,
    log: true,
    least: 0,
    only: {kinetics: ["gated", "roussel"]}
  },
  {
    key: "interface_yield_stress",
    word: "yield stress of the layer",
    symbol: "τᵢ",
    unit: "Pa",
    low: 1,
    high: 500,
    log: true,
    least: 0,
    only: {floor: ["interface"]}
  },
  {
    key: "interface_viscosity",
    word: "viscosity of the layer over its thickness",
    symbol: "kᵢ",
    unit: "Pa.s/m",
    low: 10,
    high: 10000,
    log: true,
    least: 0,
    only: {floor: ["interface"]}
  },
  {
    key: "coefficient",
    word: "friction coefficient",
    symbol: "",
    unit: "",
    low: 0,
    high: 1,
    least: 0,
    most: 10,
    only: {floor: ["friction"]}
  },
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
  "Pa.s/m": "Pa·s/m",
  "kg/m3": "kg/m³"
};

/// Whether a field counts beside the concrete's choices.
const counts = (field, concrete) => Object.entries(field.only ?? {}).every(([key, values]) => values.includes(concrete[key]));

/// The inner dimensions of a concrete's mould [m].
const mouldOf = (concrete) => moulds[concrete.mould];

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
    kinetics: "rate_power",
    destructuration: mix.destructuration ?? 0.01,
    mould: "abrams",
    floor: "no_slip",
    interface_yield_stress: 27,
    interface_viscosity: 1000,
    coefficient: mix.friction_coefficient ?? 0.35,
    lift: 15,
    duration: 120
  };
}

/// A concrete's value with its unit.
const shown = (field, concrete) => `${concrete[field.key]} ${unitShown[field.unit] ?? field.unit ?? ""}`.trim();

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
  const own = ["yield_stress", "plastic_viscosity", "density", "structuration_rate", "kinetics", "breakdown_rate", "rate_exponent"];
  return Object.keys(mixes).find((name) => own.every((key) => concreteOf(name)[key] === concrete[key])) ?? "";
}

function nameOf(concrete) {
  const name = mixOf(concrete);
  return name ? mixes[name].name : "your mix";
}

/// What tells the concretes of a picture apart.
function labelsOf(concretes) {
  const differ = (key) => concretes.some((c) => c[key] !== concretes[0][key]);
  const chosen = (c) => choices.filter(({key}) => key !== "kinetics" && differ(key)).map(({key, options}) => `, ${options[c[key]]}`);
  const labels = concretes.map((c) => nameOf(c) + (c.rest > 0 ? `, ${written(c.rest)} s of rest` : "") + chosen(c).join(""));
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
    if (c.kinetics === "rate_power")
      lines.push(`breakdown_rate     = "${c.breakdown_rate} 1/s"`, `rate_exponent      = ${c.rate_exponent}`);
    else
      lines.push(`kinetics           = "${c.kinetics}"`, `destructuration    = ${c.destructuration}`);
  }
  return lines;
}

/// The scene's lines on the floor, where it does not hold the concrete.
function floorLines(c) {
  if (c.floor === "no_slip") return [];
  const lines = ["", "[floor]", `contact = "${c.floor}"`];
  if (c.floor === "friction") return [...lines, `coefficient = ${c.coefficient}`];
  return [...lines, `interface_yield_stress = "${c.interface_yield_stress} Pa"`, `interface_viscosity = "${c.interface_viscosity} Pa.s/m"`];
}

/// The scene that `tremie run` takes.
function tomlOf(c) {
  const lines = [`# ${nameOf(c)}: slump flow after ${c.rest} s of rest.`, 'apparatus = "slump_flow"'];
  if (c.mould !== "abrams") lines.push(`cone = "${c.mould}"`);
  lines.push(...mixLines(c), "");
  lines.push("[test]", `rest       = "${c.rest} s"`, `lift_speed = "${c.lift} cm/s"`, `duration   = "${c.duration} s"`, ...floorLines(c));
  return lines.join("\n") + "\n";
}

/// "yield_stress=54&…" for each concrete, the second one's keys with a 2. A choice stands where it is not the first.
function fragmentOf(concretes) {
  const parts = new URLSearchParams();
  concretes.forEach((c, i) => {
    const set = (key) => parts.set(key + (i ? "2" : ""), c[key]);
    choices.filter(({key}) => c[key] !== concreteOf("mix_a")[key]).forEach(({key}) => set(key));
    fields.filter((f) => counts(f, c)).forEach((f) => set(f.key));
  });
  return parts.toString();
}

/// What an entry of a link gives: {value}, or {fault}.
function readEntry(key, text) {
  const choice = choices.find((c) => c.key === key), field = fields.find((f) => f.key === key);
  if (choice) return text in choice.options ? {value: text} : {fault: `allowed: ${Object.keys(choice.options).join(", ")}`};
  if (!field) return {fault: "no field has this name"};
  const value = readNumber(text), fault = wrong(field, value);
  return fault ? {fault} : {value};
}

/// {concretes, unread} of a fragment. No concretes where it holds none; Mix A's values where it gives none that can be
/// run. `unread`: a text for each entry that was not taken.
function readFragment(fragment) {
  const concretes = {}, unread = [];
  for (const [name, text] of new URLSearchParams(fragment)) {
    const suffix = name.endsWith("2") ? "2" : "", key = suffix ? name.slice(0, -1) : name;
    const field = [...fields, ...choices].find((f) => f.key === key);
    const concrete = field && (concretes[suffix] ??= concreteOf("mix_a"));
    const {value, fault} = readEntry(key, text);
    if (!fault)
      concrete[key] = value;
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
