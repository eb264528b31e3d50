// The answer in words: what was asked, the spread with its error, what it means, whether to trust it.

/// A run as the page shows it; `concrete` as the fields hold it.
function emptyRun(concrete, index) {
  return {
    concrete,
    name: nameOf(concrete),
    label: nameOf(concrete),
    lift: concrete.lift / 100,
    frames: [],
    time: [],
    spread: [],
    summary: null,
    result: null,
    colour: theme(index ? "--second" : "--first"),
    dash: index ? [8, 4] : []
  };
}

/// The spread at a time [mm], by interpolation.
function spreadAt({time, spread}, at) {
  const i = time.findIndex((t) => t >= at);
  if (i < 0) return spread.at(-1) ?? 200;
  if (i === 0) return spread[0];
  return spread[i - 1] + ((spread[i] - spread[i - 1]) * (at - time[i - 1])) / (time[i] - time[i - 1]);
}

/// A frame as it comes, before there is a series: its outermost point stands for the spread.
function addFrame(run, frame) {
  run.frames.push(frame);
  run.time.push(frame.time);
  run.spread.push(2000 * frame.points.reduce((most, value, i) => (i % 4 === 0 && value > most ? value : most), 0));
}

/// Takes the result of a run: summary, series, and the concrete that the scene says.
function addResult(run, result) {
  const rows = result.timeseries.trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  Object.assign(run, {
    result,
    summary: result.summary,
    frames: result.frames,
    time: rows.map((row) => row[0]),
    spread: rows.map((row) => row[1])
  });
}

/// The concrete of a resolved scene, in the units of the fields.
function concreteFrom(scene) {
  const number = (key, otherwise) =>
      Number(scene.match(new RegExp(`^${key} = "?([-+.\\deE]+)`, "m"))?.[1] ?? otherwise);
  const concrete = {lift: Number((100 * number("lift_speed", 1e4)).toPrecision(9))};
  for (const {key} of fields) concrete[key] ??= number(key, 0);
  return concrete;
}

/// What was measured on this mix after this rest; null where nothing was.
function measuredOn(concrete) {
  const mix = mixes[mixOf(concrete)];
  const value = mix && {0: mix.slump_flow_0, 240: mix.slump_flow_240}[concrete.rest];
  return value ? {value, tolerance: mix.slump_flow_tolerance} : null;
}

function classText({class_en12350_8: name, spread_mm: spread}) {
  const limits = {SF1: "550 to 650 mm", SF2: "660 to 750 mm", SF3: "760 to 850 mm"};
  if (name) return `Class ${name} of EN 206 (${limits[name]}, read to 10 mm)`;
  return spread < 600 ? "Below class SF1 of EN 206 (550 to 650 mm)" : "Above class SF3 of EN 206 (760 to 850 mm)";
}

/// Concrete that hardly went beyond the cone's own foot: 200 mm wide, 300 mm high.
const keptItsShape = ({spread_mm: spread, height_mm: height}) => spread < 210 && height > 270;

function measuredText(spread, {value, tolerance}) {
  const by = spread - value, sign = by < 0 ? "less" : "more";
  const stands = `Measured on this mix: ${value} ± ${tolerance} mm`;
  if (Math.abs(by) <= tolerance) return [`${stands}; the computed spread agrees`, "good"];
  return [
    `${stands}; computed ${Math.abs(by).toFixed(0)} mm ${
        sign}, beyond that. The spread computed follows from a rheometer's values, on a floor that holds the concrete.`,
    "bad"
  ];
}

const stillMoving = ({yield_stress}) => yield_stress > 0 ? "More time may be given: time of the test, at most." :
                                                           "Without a yield stress a fluid never comes to rest.";

/// What the program's line on t500 says beside its value; "" where that is to be relied on.
const doubtOfT500 = (lines) => lines.find((line) => line.startsWith("t500"))?.split(/\s{2,}/)[2] ?? "";

/// Lines of [text, class].
function verdicts(run) {
  const {results, checks} = run.summary, lines = [];
  const {spread_mm: spread, stopped_at_s: stopped, t500_s: t500} = results;
  checks.reasons.forEach((reason) => lines.push([`Not to be trusted: ${reason}`, "bad"]));
  if (stopped == null)
    lines.push([`Still moving at the end of the run: no class and no verdict. ${stillMoving(run.concrete)}`, "bad"]);
  else {
    const within = results.within_tremie_range, error = run.summary.error?.spread_mm ?? 0;
    const near = tremieRange.some((end) => Math.abs(spread - end) < error);
    lines.push([
      `${within ? "Within" : "Outside"} the range of tremie concrete (450 to 650 mm)${near ? ", nearer to its end than the error" : ""}`,
      near ? "" : within ? "good" : "bad"
    ]);
    lines.push([classText(results), ""]);
  }
  const doubt = doubtOfT500(run.result.lines);
  lines.push([(t500 == null ? "t500: never reached" : `t500 ${seconds(t500)}, from the start of the lift`) + (doubt && `; ${doubt}`), ""]);
  const height = `${millimetres(results.height_mm)} high in the middle`;
  if (stopped != null)
    lines.push([keptItsShape(results) ? `It kept the cone's shape: ${height}` : `At rest after ${seconds(stopped)}; ${height}`, ""]);
  if (run.concrete.rest > 0 && run.concrete.structuration_rate === 0)
    lines.push(["The rest changes nothing: with a structuration rate A_thix of 0 nothing builds up. A slump flow alone does not tell it.", "bad"]);
  const measured = measuredOn(run.concrete);
  if (measured && stopped != null) lines.push(measuredText(spread, measured));
  if (!checks.reasons.length) lines.push([trustText(run.summary), "note"]);
  return lines;
}

function trustText({checks, cost, error}) {
  const volume = `volume kept to ${written(100 * Math.abs(checks.volume_change), 1)} %`;
  const steps = checks.unconverged_steps ? `${checks.unconverged_steps} of ${cost.steps} steps did not converge` :
                                           `all ${cost.steps} steps converged`;
  const bar = error?.spread_mm ?
      "The error is what finer cells and steps may still change; it does not cover the mix's values. " :
      "";
  return `${bar}Checks: ${steps}, ${volume}. Computed in ${seconds(cost.wall_s)}.`;
}

/// Fills the answer of a run into its block.
function showAnswer(block, run, errorState) {
  const {summary, concrete} = run, part = (name) => block.querySelector(`.${name}`);
  const rest = concrete.rest > 0 ? `after ${written(concrete.rest)} s of rest` : "without rest";
  part("asked").textContent = `${run.name}, slump flow ${rest}`;
  part("spread").textContent = summary ? summary.results.spread_mm.toFixed(0) : "–";
  if (summary) part("spread").dataset.value = summary.results.spread_mm;
  const error = summary?.error?.spread_mm;
  part("error").textContent = error ? `± ${Math.max(1, Math.ceil(error))}` : "";
  part("later").textContent = summary && !error ? errorState : "";
  part("verdicts")
      .replaceChildren(...(summary ? verdicts(run).map(([text, kind]) => element("li", {class: kind}, text)) : []));
}
