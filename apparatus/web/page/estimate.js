// Yield stress and plastic viscosity from a measured slump flow and its t500, as `tremie estimate` has them.

const measuredFields = [
  {key: "spread_mm", word: "slump flow", unit: "mm", value: "590"},
  {key: "t500_s", word: "t500, where measured", unit: "s", value: ""},
  {key: "spread_error_mm", word: "standard error of the slump flow", unit: "mm", value: "15"},
  {key: "t500_error_s", word: "standard error of t500", unit: "s", value: "0.2"},
];

/// window.tremie.estimate: {spread_mm, t500_s, spread_error_mm, t500_error_s, density_kg_m3}, the first alone needed.
async function estimateFor({spread_mm, t500_s = NaN, spread_error_mm = 15, t500_error_s = 0.2, density_kg_m3 = 2400}) {
  if (spread_mm === undefined) throw new Error("slump flow: write a number");
  if (!(spread_mm > 200)) throw new Error("slump flow: must be more than the cone's 200 mm at its bottom");
  if (!Number.isNaN(t500_s) && !(t500_s > 0)) throw new Error("t500: must be above 0");
  if (!(spread_error_mm > 0 && t500_error_s > 0)) throw new Error("standard errors: must be above 0");
  return solveEstimate({
    spread: spread_mm / 1000,
    spreadError: spread_error_mm / 1000,
    t500: t500_s,
    t500Error: t500_error_s,
    density: density_kg_m3
  });
}

function intervalText(word, interval, unit) {
  if (!interval) return `${word}: not identifiable from these values`;
  const [low, high] = interval.ci95.map((value) => written(value, 3));
  return `${word} ${written(interval.value, 3)} ${unit}, 95 % between ${low} and ${high}`;
}

function showEstimate({results, checks}, hasT500) {
  const lines = [[intervalText("Yield stress", results.yield_stress_Pa, "Pa"), ""]];
  lines.push(
      hasT500 ? [intervalText("Plastic viscosity", results.plastic_viscosity_Pa_s, "Pa·s"), ""] :
                ["Plastic viscosity: needs t500", "note"]);
  checks.reasons.forEach((reason) => lines.push([`Not to be trusted: ${reason}`, "bad"]));
  lines.push(["For a lift of 15 cm/s, of concrete that builds up nothing while it flows: what its rest built up is in the yield stress.", "note"]);
  byId("estimate-answer").replaceChildren(...lines.map(([text, kind]) => element("li", {class: kind}, text)));
}

/// Builds fields and buttons; density() of the concrete that is being changed, take({yield_stress, plastic_viscosity}).
function buildEstimate(place, density, take) {
  for (const {key, word, unit, value} of measuredFields) {
    const text = element("input", {type: "text", id: `measured-${key}`, inputmode: "decimal", autocomplete: "off", value});
    const box = element("div", {class: "value"}, text, element("span", {class: "unit"}, unit));
    place.append(element("div", {class: "field"}, element("label", {for: `measured-${key}`}, word), box));
  }
  let found = {};
  const read = ({key, word}) => {
    const field = byId(`measured-${key}`), text = field.value.trim(), value = readNumber(text);
    mark(field, text && Number.isNaN(value));
    if (text && Number.isNaN(value)) throw new Error(`${word}: write a number, not ${text}`);
    return text ? value : undefined;
  };
  const run = async () => {
    byId("estimate-wrong").textContent = "";
    try {
      const measured = {density_kg_m3: density()};
      for (const field of measuredFields) measured[field.key] = read(field);
      const answer = await estimateFor(measured), {yield_stress_Pa: tau, plastic_viscosity_Pa_s: mu} = answer.results;
      found = {...(tau && {yield_stress: Number(tau.value.toPrecision(3))}), ...(mu && {plastic_viscosity: Number(mu.value.toPrecision(3))})};
      if (answer.checks.reasons.length) found = {};
      showEstimate(answer, measured.t500_s !== undefined);
    } catch (error) {
      found = {};
      byId("estimate-answer").replaceChildren();
      byId("estimate-wrong").textContent = error.message;
    }
    byId("estimate-take").disabled = !("yield_stress" in found);
  };
  byId("estimate-run").addEventListener("click", run);
  byId("estimate-take").addEventListener("click", () => take(found));
}
