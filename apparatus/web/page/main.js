// The page's state, and what happens on it.

const state = {
  concretes: [],
  active: 0,
  runs: [],
  by: "rate",
  errorState: "",
  turn: 0
};
const still = matchMedia("(prefers-reduced-motion: reduce)");

function view() {
  const frames = state.runs.flatMap((run) => run.frames), quantity = quantities[state.by];
  const shapes = state.runs.map((run) => mouldOf(run.concrete)), size = Math.max(...shapes.map((shape) => shape.bottom_radius)) / 0.1;
  const widest = Math.max(560 * size, ...state.runs.map((run) => run.spread.at(-1) ?? 0)) / 2000;
  const range = (state.range ??= quantity.range(frames));
  return {
    shade: shadeBy(quantity, range),
    at: quantity.at,
    reach: widest + 0.04 * size,
    ratio: (1.2 * Math.max(...shapes.map((shape) => shape.height))) / (2 * widest + 0.08 * size),
    ring: 0.004 * size,
    range
  };
}

function draw() {
  const seen = view(), {time} = player;
  drawSection(byId("section"), state.runs, time, seen);
  drawPlate(byId("plate"), state.runs, time, seen);
  drawChart(byId("chart"), state.runs, time);
  document.querySelector(".at-rest").hidden = !quantities[state.by].log;
  byId("low").textContent = written(seen.range[0], 2);
  byId("high").textContent = written(seen.range[1], 2);
  const now = state.runs.map((run) => `${run.label}: ${millimetres(spreadAt(run, time))}`).join(", ");
  byId("reading").textContent = state.runs.some((run) => run.time.length) ? now : "";
}

function showAnswers() {
  document.querySelectorAll(".outcome").forEach((block, i) => {
    block.hidden = !state.runs[i];
    if (state.runs[i]) showAnswer(block, state.runs[i], state.errorState);
  });
  const ready = state.runs.length > 0 && state.runs.every((run) => run.summary && !run.opening);
  ["save-png", "save-csv"].forEach((id) => (byId(id).disabled = !ready));
}

function showProgress({time, duration, run}, which) {
  const name = state.runs.length === 2 ? `${state.runs[which].label}: ` : "";
  byId("progress").value = Math.min(1, time / duration);
  byId("stage").textContent = run ? `${name}error bar, coarser run at ${time.toFixed(1)} s` :
                                    `${name}${time.toFixed(1)} s of at most ${duration.toFixed(0)} s of flow`;
}

function busy(on) {
  document.body.classList.toggle("busy", on);
  byId("cancel").disabled = !on;
  if (!on) byId("stage").textContent = "", (byId("progress").value = 0);
}

function complain(message) {
  byId("trouble").textContent = message;
  if (message) byId("said").textContent = "";
}

/// Whether a field cannot be read, or values cannot be run beside each other; says which.
function refused() {
  const field = firstWrong();
  const fault = field ? byId(`wrong-${field.key}`).textContent : state.concretes.map(wrongTogether).find(Boolean);
  const before = state.runs.some((run) => run.summary) ? " The result is that of the values before." : "";
  if (fault) complain(`${fault}. Nothing was run, saved or copied.${before}`);
  return Boolean(fault);
}

/// Brings the result into view where the page is one column; the focus stays.
function seeResult() {
  const narrow = matchMedia("(max-width: 800px)").matches;
  if (narrow) document.querySelector(".answers").scrollIntoView({behavior: still.matches ? "auto" : "smooth"});
}

/// Runs one scene into one run of the page; `turn` tells whether it is still wanted. Settles with the result, and with
/// `over`: a promise of the result with its error bar, null where that was given up.
async function runInto(run, which, scene, turn) {
  const wanted = () => turn === state.turn;
  let done, last = null;
  const over = new Promise((resolve) => (done = resolve));
  const result = await solve(scene, {
    withError: true,
    onProgress: (progress) => wanted() && showProgress(progress, which),
    onFrame: (frame) => wanted() &&
        (addFrame(run, frame), (state.range = null), (player.end = Math.max(0.5, frame.time)), showComing(frame.time)),
    onErrorBar: (whole) => ((last = whole), wanted() && ((run.summary = whole.summary), showAnswers())),
    onDone: () => done(last),
  });
  if (wanted()) addResult(run, result), showAnswers();
  return {result, over};
}

/// What the page opens on: the result of the first concrete as the program computed it when the page was made.
function openingRun(concrete) {
  const {time, spread, ...result} = JSON.parse(byId("opening").textContent);
  return {...emptyRun(concrete, 0), opening: true, result, summary: result.summary, time, spread};
}

/// Whether it is the concrete that the opening's result is of.
const isOpening = ([concrete, ...others]) => !others.length && fragmentOf([concrete]) === fragmentOf([concreteOf("mix_a")]);

function start(concretes) {
  const first = state.turn === 0 && isOpening(concretes);
  cancelAll();
  state.turn += 1;
  state.range = null;
  state.runs = first ? concretes.map(openingRun) : concretes.map(emptyRun);
  labelsOf(concretes).forEach((label, i) => (state.runs[i].label = label));
  state.errorState = "computing the error …";
  if (first) player.end = state.runs[0].time.at(-1);
  complain("");
  byId("unread").textContent = byId("said").textContent = "";
  busy(true);
  showAnswers();
  showAt(first ? player.end : 0);
  return state.turn;
}

function finish(turn) {
  if (turn !== state.turn) return;
  state.range = null;
  player.end = Math.max(...state.runs.map((run) => run.time.at(-1) ?? 0), 0.5);
  still.matches ? showAt(player.end) : play(0);
}

/// Runs the page's concretes, one after the other.
async function runAll() {
  const turn = start(state.concretes);
  history.replaceState(null, "", `#${fragmentOf(state.concretes)}`);
  if (refused()) return cancel();
  try {
    for (const [i, run] of state.runs.entries()) {
      const {over} = await runInto(run, i, tomlOf(run.concrete), turn);
      if (i === state.runs.length - 1) finish(turn);
      await over;
    }
    if (turn === state.turn) (state.errorState = ""), busy(false), showAnswers();
  } catch (error) {
    if (turn !== state.turn) return;
    busy(false), (state.errorState = "");
    showAnswers();
    if (error.message !== "cancelled") complain(error.message);
  }
}

/// Ends what runs; what has come so far stays.
function cancel() {
  state.turn += 1;
  state.errorState = "";
  cancelAll();
  busy(false);
  showAnswers();
}

let apiRuns = Promise.resolve();

/// window.tremie.run: a scene, as TOML text or an object of its keys, to its summary.json; {withError: true}: to that
/// with its error bar. Calls wait for each other.
function runScene(scene, {withError = false} = {}) {
  const answer = apiRuns.then(() => runForApi(scene, withError));
  apiRuns = answer.catch(() => {});
  return answer;
}

async function runForApi(scene, withError) {
  const turn = start([state.concretes[0]]);
  state.runs[0].name = state.runs[0].label = "your scene";
  try {
    const {result, over} = await runInto(state.runs[0], 0, scene, turn);
    if (turn === state.turn) {
      const concrete = concreteFrom(result.scene);
      Object.assign(
          state.runs[0], {concrete, name: nameOf(concrete), label: labelsOf([concrete])[0], lift: concrete.lift / 100});
      state.concretes = [concrete], (state.active = 0);
      showChoice(), showAnswers(), finish(turn);
      over.then(() => turn === state.turn && ((state.errorState = ""), busy(false), showAnswers()));
    }
    return ((withError && (await over)) || result).summary;
  } catch (error) {
    if (turn === state.turn) busy(false), complain(error.message);
    throw error;
  }
}

function showChoice() {
  const two = state.concretes.length === 2;
  byId("second").checked = two;
  byId("which").hidden = !two;
  document.querySelectorAll('input[name="which"]')
      .forEach((radio) => (radio.checked = Number(radio.value) === state.active));
  showConcrete(state.concretes[state.active]);
}

function change(concrete) {
  state.concretes[state.active] = concrete;
  showChoice();
  runAll();
}

/// Takes one field's value; what another field cannot read stays in it, and nothing is run.
function changeField(key, value) {
  const concrete = {...state.concretes[state.active], [key]: value};
  if (!firstWrong()) return change(concrete);
  state.concretes[state.active] = concrete;
  refused();
}

function chooseSecond(on) {
  const other = mixOf(state.concretes[0]) === "mix_c" ? "mix_a" : "mix_c";
  state.concretes =
      on ? [state.concretes[0], {...concreteOf(other), rest: state.concretes[0].rest, mould: state.concretes[0].mould}] : [state.concretes[0]];
  state.active = on ? 1 : 0;
  showChoice();
  runAll();
}

function listen() {
  const whenRead = (id, act) => byId(id).addEventListener("click", () => {
    if (!refused()) return act();
    const field = firstWrong();
    if (field) byId(`field-${field.key}`).focus();
  });
  whenRead("run", () => (runAll(), seeResult()));
  byId("to-fields").addEventListener("click", () => document.querySelector(".controls").scrollIntoView());
  byId("cancel").addEventListener("click", () => {
    cancel();
    byId("said").textContent = "Cancelled: what had come until then is shown.";
    byId("run").focus();
  });
  byId("second").addEventListener("change", (event) => chooseSecond(event.target.checked));
  document.querySelectorAll('input[name="which"]')
      .forEach((radio) => radio.addEventListener("change", () => ((state.active = Number(radio.value)), showChoice())));
  document.querySelectorAll('input[name="by"]')
      .forEach(
          (radio) => radio.addEventListener("change", () => ((state.by = radio.value), (state.range = null), draw())));
  whenRead(
      "save-toml",
      () => labelsOf(state.concretes).forEach((label, i) => saveToml({concrete: state.concretes[i], label})));
  whenRead("save-csv", () => state.runs.forEach(saveCsv));
  whenRead("save-png", () => savePng(state.runs));
  whenRead("copy-link", () => copyLink(byId("said")));
  window.addEventListener("resize", draw);
  window.addEventListener("hashchange", () => load(location.hash.slice(1)));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    state.runs.forEach((run, i) => (run.colour = theme(i ? "--second" : "--first")));
    draw();
  });
}

/// Takes a link's fragment, and says what of it was not read.
function load(fragment) {
  const {concretes, unread} = readFragment(fragment);
  state.concretes = concretes.length ? concretes : [concreteOf("mix_a")];
  state.active = 0;
  showChoice();
  runAll();
  if (unread.length) byId("unread").textContent = `Not read from the link: ${unread.join(", ")}.`;
}

buildMixes((name) => {
  const {rest, lift, duration, mould, floor} = state.concretes[state.active];
  change({...concreteOf(name), rest, lift, duration, mould, floor});
  seeResult();
});
buildChoices(byId("choices"), changeField);
buildFields(byId("fields"), changeField);
buildEstimate(
    byId("estimate-fields"), () => state.concretes[state.active].density,
    (values) => {
      const now = state.concretes[state.active];
      // Such a mix may creep for longer than a test is given at first; a run ends where the flow does.
      change({...now, ...values, mould: "abrams", floor: "no_slip", rest: 0, structuration_rate: 0, duration: Math.max(now.duration, 120)});
      byId("said").textContent = "Rest and structuration rate are 0 now, one spread does not tell them; the test may take 120 s.";
      seeResult();
    });
buildPlayer();
player.draw = draw;
byId("scale").style.background = `linear-gradient(to right, ${shades.join(", ")})`;
listen();
window.tremie = {
  run: runScene,
  estimate: estimateFor,
  version: byId("version").textContent
};
load(location.hash.slice(1));
