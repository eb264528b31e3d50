// The time that is shown: played, paused, drawn along by the slider.

const player = {
  time: 0,
  end: 1,
  playing: false,
  drawnAt: 0,
  draw: () => {}
};

function showTime() {
  byId("scrubber").value = Math.round((1000 * player.time) / player.end);
  byId("scrubber").setAttribute("aria-valuetext", seconds(player.time));
  byId("time").textContent = `${player.time.toFixed(2)} s`;
  byId("play").textContent = player.playing ? "Pause" : "Play";
  player.draw();
}

function play(from = player.time >= player.end ? 0 : player.time) {
  player.playing = true;
  const started = performance.now() - 1000 * from;
  const tick = (now) => {
    if (!player.playing) return;
    player.time = Math.min(player.end, Math.max(0, (now - started) / 1000));
    if (player.time >= player.end) player.playing = false;
    showTime();
    requestAnimationFrame(tick);
  };
  requestAnimationFrame(tick);
}

function showAt(time) {
  player.playing = false;
  player.time = Math.min(time, player.end);
  showTime();
}

/// While it is computed: ten pictures a second, which leave the machine to the computation.
function showComing(time) {
  if (performance.now() - player.drawnAt < 100) return;
  showAt(time);
  player.drawnAt = performance.now();
}

function buildPlayer() {
  byId("play").addEventListener("click", () => (player.playing ? showAt(player.time) : play()));
  byId("scrubber").addEventListener("input", () => showAt((player.end * byId("scrubber").value) / 1000));
}
