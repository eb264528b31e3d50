// The answer in words: what was asked, the spread with its error, what it means, whether to trust it.

/// Whether classes, the accepted range and t500 apply: those of the Abrams cone.
const hasClasses = ({concrete}) => concrete.mould === "abrams";

/// The diameter of the mould's foot [mm].
const footOf = ({concrete}) => 2000 * mouldOf(concrete).bottom_radius;

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
function spreadAt(run, at) {
  const {time, spread} = run, i = time.findIndex((t) => t >= at);
  if (i < 0) return spread.at(-1) ?? footOf(run);
  if (i === 0) return spread[0];
  return spread[i - 1] + ((spread[i] - spread[i - 1]) * (at - time[i - 1])) / (time[i] - time[i - 1]);
}

/// A frame as it comes, before there is a series: its outermost point stands for the spread.
function addFrame(run, frame) {
  run.frames.push(frame);
  if (run.opening) return;
  run.time.push(frame.time);
  run.spread.push(2000 * frame.points.reduce((most, value, i) => (i % 4 === 0 && value > most ? value : most), 0));
}

/// Takes the result of a run: summary, series, and the concrete that the scene says.
function addResult(run, result) {
  const rows = result.timeseries.trim().split("\n").slice(1).map((row) => row.split(",").map(Number));
  const error = result.summary.error ?? (run.opening ? run.summary.error : undefined);
  Object.assign(run, {
    result,
    opening: false,
    summary: error ? {...result.summary, error} : result.summary,
    frames: result.frames,
    time: rows.map((row) => row[0]),
    spread: rows.map((row) => row[1])
  });
}

/// The mould of a resolved scene by its dimensions; the Abrams cone where it is another.
function mouldFrom(scene) {
  const radius = (key) => Number(scene.match(new RegExp(`^${key} = "([.\\deE+-]+) m"`, "m"))?.[1]);
  const near = (a, b) => Math.abs(a - b) < 1e-9;
  const same = ([, mould]) => ["top_radius", "bottom_radius"].every((key) => near(radius(key), mould[key])) &&
      scene.includes(`name = "${mould.name}"`);
  return Object.entries(moulds).find(same)?.[0] ?? "abrams";
}

/// The word of a choice in a resolved scene, where the page has it.
function wordFrom(scene, line, {options}, otherwise) {
  const word = scene.match(new RegExp(`^${line} = "(\\w+)"`, "m"))?.[1];
  return word in options ? word : otherwise;
}

/// The concrete of a resolved scene, in the units of the fields.
function concreteFrom(scene) {
  const number = (key, otherwise) =>
      Number(scene.match(new RegExp(`^${key} = "?([-+.\\deE]+)`, "m"))?.[1] ?? otherwise);
  const usual = concreteOf("mix_a");
  const concrete = {
    lift: Number((100 * number("lift_speed", 1e4)).toPrecision(9)),
    mould: mouldFrom(scene),
    kinetics: wordFrom(scene, "kinetics", choices[1], usual.kinetics),
    floor: wordFrom(scene, "contact", choices[2], usual.floor)
  };
  for (const {key, only} of fields) concrete[key] ??= number(key, only ? usual[key] : 0);
  return concrete;
}

/// What was measured on this mix after this rest; null where nothing was.
function measuredOn(concrete) {
  const mix = concrete.mould === "abrams" && mixes[mixOf(concrete)];
  const value = mix && {0: mix.slump_flow_0, 240: mix.slump_flow_240}[concrete.rest];
  return value ? {value, tolerance: mix.slump_flow_tolerance} : null;
}

function classText({class_en12350_8: name, spread_mm: spread}) {
  const limits = {SF1: "550 to 650 mm", SF2: "660 to 750 mm", SF3: "760 to 850 mm"};
  if (name) return `Class ${name} of EN 206 (${limits[name]}, read to 10 mm)`;
  return spread < 600 ? "Below class SF1 of EN 206 (550 to 650 mm)" : "Above class SF3 of EN 206 (760 to 850 mm)";
}

/// Concrete that hardly went beyond the mould's own foot.
const keptItsShape = ({spread_mm: spread, height_mm: height}, run) =>
    spread < 1.05 * footOf(run) && height > 900 * mouldOf(run.concrete).height;

function measuredText(spread, {value, tolerance}) {
  const by = spread - value, sign = by < 0 ? "less" : "more";
  const stands = `Measured on this mix: ${value} ± ${tolerance} mm`;
  if (Math.abs(by) <= tolerance) return [`${stands}; the computed spread agrees`, "good"];
  return [
    `${stands}; computed ${Math.abs(by).toFixed(0)} mm ${
        sign}, beyond that. The spread computed follows from a rheometer's values and from the floor.`,
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
  else if (hasClasses(run)) {
    const within = results.within_tremie_range, error = run.summary.error?.spread_mm ?? 0;
    const near = tremieRange.some((end) => Math.abs(spread - end) < error);
    lines.push([
      `${within ? "Within" : "Outside"} the range of tremie concrete (450 to 650 mm)${near ? ", nearer to its end than the error" : ""}`,
      near ? "" : within ? "good" : "bad"
    ]);
    lines.push([classText(results), ""]);
  }
  const doubt = doubtOfT500(run.result.lines);
  if (hasClasses(run)) lines.push([(t500 == null ? "t500: never reached" : `t500 ${seconds(t500)}, from the start of the lift`) + (doubt && `; ${doubt}`), ""]);
  const height = `${millimetres(results.height_mm)} high in the middle`;
  if (stopped != null)
    lines.push([keptItsShape(results, run) ? `It kept the cone's shape: ${height}` : `At rest after ${seconds(stopped)}; ${height}`, ""]);
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
  return `${bar}Checks: ${steps}, ${volume}. Computed ${cost.wall_s ? `in ${seconds(cost.wall_s)}` : "beforehand; again on this device now"}.`;
}

/// Fills the answer of a run into its block.
function showAnswer(block, run, errorState) {
  const {summary, concrete} = run, part = (name) => block.querySelector(`.${name}`);
  const rest = concrete.rest > 0 ? `after ${written(concrete.rest)} s of rest` : "without rest";
  const mould = hasClasses(run) ? "" : ` from the mould “${mouldOf(concrete).name}”`;
  part("asked").textContent = `${run.name}, slump flow${mould} ${rest}`;
  part("spread").textContent = summary ? summary.results.spread_mm.toFixed(0) : "–";
  if (summary) part("spread").dataset.value = summary.results.spread_mm;
  const error = summary?.error?.spread_mm;
  part("error").textContent = error ? `± ${Math.max(1, Math.ceil(error))}` : "";
  part("later").textContent = summary && !error ? errorState : "";
  part("verdicts")
      .replaceChildren(...(summary ? verdicts(run).map(([text, kind]) => element("li", {class: kind}, text)) : []));
}
