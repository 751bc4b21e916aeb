// a finger on a figure scrolls the page
const touch = matchMedia("(pointer: coarse)").matches;
for (const [id, { data, layout }] of Object.entries(figures)) {
  Plotly.newPlot(id, data, { ...layout, dragmode: touch ? false : "zoom" }, { responsive: true, displaylogo: false });
}
// figures have the width of the screen; paper has its own
const printed = matchMedia("print");
printed.addEventListener("change", () => Object.keys(figures).forEach((id) => Plotly.Plots.resize(id)));
