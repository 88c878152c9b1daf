// Colours. Cloths take front and back in turn; red is kept for intersections, and no front is as dark and as warm.

const clothColours = [
  {front: "#4a7fb5", back: "#d9b26a"},
  {front: "#dcbd7e", back: "#6f93a8"},
  {front: "#8cc4bd", back: "#b79a7a"},
  {front: "#8d76b3", back: "#c9c28a"},
];
const energyColours = {
  kinetic: "#3f8ae0",
  gravity: "#8a939d",
  membrane: "#e0922f",
  bending: "#2fa58a",
  spring: "#a0569c"
};
const strainStops = ["#2b2f6b", "#2c5f9e", "#2f93a6", "#63bd8c", "#c5d968", "#fff3a3"];

function linear(colour) { return new THREE.Color(colour).convertSRGBToLinear(); }

// 256 colours between the stops, three numbers in [0, 1] each; as light if `linearised`, as written if not.
function strainTable(linearised) {
  const stops = strainStops.map((stop) => new THREE.Color(stop));
  const table = new Float32Array(3 * 256);
  for (let i = 0; i < 256; ++i) {
    const at = (i / 255) * (stops.length - 1), below = Math.min(Math.floor(at), stops.length - 2);
    const colour = stops[below].clone().lerp(stops[below + 1], at - below);
    if (linearised) colour.convertSRGBToLinear();
    colour.toArray(table, 3 * i);
  }
  return table;
}

function drawStrainScale(canvas) {
  const context = canvas.getContext("2d"), table = strainTable(false);
  const image = context.createImageData(256, 1);
  for (let i = 0; i < 256; ++i) {
    for (let k = 0; k < 3; ++k) image.data[4 * i + k] = 255 * table[3 * i + k];
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}
