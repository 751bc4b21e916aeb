// a finger on a figure scrolls the page
const touch = matchMedia("(pointer: coarse)").matches;
const config = {
  responsive: true,
  displaylogo: false,
  displayModeBar: touch ? false : "hover",
  modeBarButtons: [["zoom2d", "pan2d", "resetScale2d", "toImage"]],
};
for (const [id, { data, layout }] of Object.entries(figures)) {
  Plotly.newPlot(id, data, { ...layout, dragmode: touch ? false : "zoom" }, config);
}
// figures have the width of the window; for paper they get that of a page
const resize = (width) =>
  Object.keys(figures).forEach((id) => Plotly.relayout(id, width ? { width, autosize: false } : { width: null, autosize: true }));
addEventListener("beforeprint", () => resize(680));
addEventListener("afterprint", () => resize(null));
