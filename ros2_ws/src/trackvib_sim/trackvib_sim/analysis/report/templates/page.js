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
// figures have the width of the screen; paper has its own
matchMedia("print").addEventListener("change", () => Object.keys(figures).forEach((id) => Plotly.Plots.resize(id)));
