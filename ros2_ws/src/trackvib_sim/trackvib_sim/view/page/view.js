// Starts Rerun's viewer and hands it the pieces of the recording, one after the other, as the server has them.
"use strict";

const word = document.getElementById("word");
const query = new URLSearchParams(location.search);

async function start() {
  await wasm_bindgen({ module_or_path: "re_viewer_bg.wasm" });
  const viewer = new wasm_bindgen.WebHandle({
    url: [],
    render_backend: query.get("renderer"), // "webgl" or "webgpu"; null for the better one
    hide_welcome_screen: true,
    enable_history: false,
    notebook: false,
    persist: false,
  });
  await viewer.start(document.getElementById("viewer"));
  word.remove();
  viewer.open_channel("trackvib", "trackvib");
  for (let piece = 0; ; ) {
    const answer = await fetch(`pieces/${piece}`);
    if (answer.status === 410) break; // that was the last one
    if (answer.status === 204) continue; // none yet, ask again
    if (!answer.ok) throw new Error(`piece ${piece}: ${answer.status}`);
    viewer.send_rrd_to_channel("trackvib", new Uint8Array(await answer.arrayBuffer()));
    piece += 1;
    document.documentElement.dataset.pieces = piece;
  }
  viewer.close_channel("trackvib");
  document.documentElement.dataset.state = "complete";
}

start().catch((error) => {
  document.body.append(word);
  word.textContent = `the viewer cannot be shown: ${error}`;
});
