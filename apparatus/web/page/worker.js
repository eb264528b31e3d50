// The worker: the library, one scene at a time. Told {module} first, then {toml, overrides, withError}.
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

onmessage = async ({data}) => {
  if (data.module) {
    library = load(data.module);
    return;
  }
  const types = ["string", "string", "number"];
  try {
    (await library).ccall("tremie_page_run", null, types, [data.toml, data.overrides, data.withError ? 1 : 0]);
  } catch (fault) {
    postMessage({error: `the run broke off: ${fault.message ?? fault}`});
  }
  postMessage({done: true});
};
