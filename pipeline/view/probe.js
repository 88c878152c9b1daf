// Self-check for browser tests (#probe=0,30): draws the named frames through the slider and writes what the drawing
// holds into the page: covered share of the canvas and the box round that as shares of it, from the lower left, mean
// and spread of the brightness, and a hash of all pixels.

function measure(renderer) {
  const gl = renderer.getContext(), width = gl.drawingBufferWidth, height = gl.drawingBufferHeight;
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let covered = 0, sum = 0, squares = 0, red = 0, hash = 2166136261;
  let left = width, right = 0, bottom = height, top = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const light = (pixels[i] + pixels[i + 1] + pixels[i + 2]) / 3;
    if (pixels[i + 3] > 250) {
      const x = (i / 4) % width, y = Math.floor(i / 4 / width);
      ++covered;
      if (x < left) left = x;
      if (x + 1 > right) right = x + 1;
      if (y < bottom) bottom = y;
      if (y + 1 > top) top = y + 1;
    }
    red += pixels[i] > 200 && pixels[i + 1] < 90 && pixels[i + 2] < 90;
    sum += light;
    squares += light * light;
    for (let k = 0; k < 4; ++k) hash = Math.imul(hash ^ pixels[i + k], 16777619);
  }
  const count = width * height, mean = sum / count;
  return {
    width,
    height,
    covered: covered / count,
    box: {left: left / width, right: right / width, bottom: bottom / height, top: top / height},
    red,
    mean,
    spread: Math.sqrt(Math.max(0, squares / count - mean * mean)),
    hash: hash >>> 0
  };
}

function probe(frames, slider, drawNow, renderer) {
  const report = frames.map((frame) => {
    slider.value = frame;
    slider.dispatchEvent(new Event("input"));
    drawNow();
    return {asked: frame, shown: window.selvedge.frame, ...measure(renderer)};
  });
  const output = document.createElement("script");
  output.type = "application/json";
  output.id = "probe";
  output.textContent = JSON.stringify(report);
  document.body.append(output);
}
