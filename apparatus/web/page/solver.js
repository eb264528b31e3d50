// Runs scenes in a worker, one after the other.
//
// solve(scene, look) -> promise of {summary, scene, timeseries, frames}; look: {withError, onProgress, onFrame,
// onErrorBar, onDone}.
// What a run still owes when the next one is asked for, its error bar, is given up; the result stands.

const solver = {
  worker: null,
  live: null,
  module: null,
  queue: [],
  job: null
};

async function compiled() {
  const base64 = byId("wasm").textContent.trim();
  solver.module ??= WebAssembly.compile(Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)));
  return solver.module;
}

async function startWorker() {
  const source = new Blob([byId("worker").textContent], {type: "text/javascript"});
  const url = URL.createObjectURL(source);
  const worker = new Worker(url);
  worker.postMessage({module: await compiled()});
  const told = (data) => worker === solver.live && solver.job && take(solver.job, data);
  worker.onmessage = ({data}) => told(data);
  worker.onerror = (event) => told({error: event.message, done: true});
  solver.live = worker;
  return worker;
}

/// What the worker says about the running job.
function take(job, {progress, frame, result, error, done}) {
  if (progress) job.look.onProgress?.(progress);
  if (frame) job.frames.push(frame), job.look.onFrame?.(frame);
  if (error) job.reject(new Error(error));
  if (result) {
    const whole = {...result, frames: job.frames};
    if (job.answered)
      job.look.onErrorBar?.(whole);
    else
      (job.answered = true), job.resolve(whole);
  }
  if (done) {
    solver.job = null;
    job.look.onDone?.();
    next();
  }
}

async function next() {
  if (solver.job || !solver.queue.length) return;
  const job = (solver.job = solver.queue.shift());
  solver.worker ??= startWorker();
  const worker = await solver.worker;
  if (solver.job === job) worker.postMessage(job.message);
}

/// Ends the running job, and with it its worker.
function stopJob(reason) {
  const job = solver.job;
  if (!job) return;
  solver.worker?.then((worker) => worker.terminate());
  solver.worker = solver.live = solver.job = null;
  if (!job.answered) job.reject(new Error(reason));
  job.look.onDone?.();
}

function cancelAll() {
  for (const job of solver.queue.splice(0)) job.reject(new Error("cancelled"));
  stopJob("cancelled");
}

function enqueue(message, look, giveWay) {
  return new Promise((resolve, reject) => {
    solver.queue.push({message, look, resolve, reject, frames: [], answered: false});
    if (giveWay && solver.job?.answered) stopJob("cancelled");
    next();
  });
}

async function solve(scene, look = {}) {
  return enqueue({...sceneText(scene), withError: look.withError ?? false}, look, true);
}

/// {results, checks} of `tremie estimate --json`, in SI but for the keys' units; waits for what runs.
async function solveEstimate(measured) {
  const {results, checks} = await enqueue({estimate: measured}, {}, false);
  return {results, checks};
}
