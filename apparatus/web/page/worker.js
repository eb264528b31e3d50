// The worker: the library, one scene at a time. Told {module} first, then {toml, overrides, withError}
// or {estimate: {spread, spreadError, t500, t500Error, density}} in SI.
let library = null;

function load(module) {
  return tremieWasm({
    instantiateWasm: (imports, done) => {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
    onProgress: (time, duration, run) => postMessage({progress: {time, duration, run}}),
    onFrame: (time, points) => postMessage({frame: {time, points}}, [points.buffer]),
    onResult: (json) => postMessage({result: JSON.parse(json)}),
    onError: (message) => postMessage({error: message}),
  });
}

function run(ccall, {toml, overrides, withError}) {
  ccall("tremie_page_run", null, ["string", "string", "number"], [toml, overrides, withError ? 1 : 0]);
}

function estimate(ccall, {spread, spreadError, t500, t500Error, density}) {
  ccall("tremie_page_estimate", null, Array(5).fill("number"), [spread, spreadError, t500, t500Error, density]);
}

onmessage = async ({data}) => {
  if (data.module) {
    library = load(data.module);
    return;
  }
  try {
    const {ccall} = await library;
    data.estimate ? estimate(ccall, data.estimate) : run(ccall, data);
  } catch (fault) {
    postMessage({error: `the run broke off: ${fault.message ?? fault}`});
  }
  postMessage({done: true});
};
