// One renderer and one camera for all runs; each run is a scene drawn into its panel's rectangle.

const smaller = (a, b) => Math.min(a, b), larger = (a, b) => Math.max(a, b);
const sizeOf = (box) => box.getSize(new THREE.Vector3()).length();

// A floor or a wall: far larger than the cloth ever is; not framed, and casting no shadow.
function isBackdrop(body, clothBoxes) {
  const largestOf = (boxes) => boxes.reduce((most, box) => Math.max(most, sizeOf(box)), 0);
  return largestOf(body.boxes) > 2.2 * largestOf(clothBoxes);
}

// Higher than wide, as someone who stands.
function isSlender(box) {
  const size = box.getSize(new THREE.Vector3());
  return size.y > 1.3 * Math.max(size.x, size.z);
}

// Points of the surfaces in up to 24 drawn frames, as far as they lie in `near`, relative to the camera's path: what
// `look` has to fit into the window.
function framedPoints(run, bodies, near, path) {
  const points = [], point = new THREE.Vector3(), frames = run.drawn.length, stride = Math.ceil(frames / 24);
  const add = ({levels, step}, vertices, frame, k) => {
    const every = Math.ceil(vertices / 800);
    for (let v = 0; v < vertices; v += every) {
      point.fromArray(levels, 3 * (frame * vertices + v)).multiplyScalar(step);
      if (near.containsPoint(point)) points.push(point.clone().sub(path[k]));
    }
  };
  for (let k = 0; k < frames; k += stride) {
    add(run.positions, run.vertices, k, k);
    for (const body of bodies) add(body.positions, body.vertices, body.moving ? k : 0, k);
  }
  return points;
}

// Places of a moving thing by frame, each the mean of those less than half a second before and after. Times ascend.
function smoothed(places, times) {
  let first = 0;
  return places.map((_, k) => {
    while (times[k] - times[first] >= 0.5) ++first;
    const mean = new THREE.Vector3();
    let i = first;
    for (; i < places.length && times[i] - times[k] < 0.5; ++i) mean.add(places[i]);
    return mean.divideScalar(i - first);
  });
}

// What the camera must show of the first run: in every frame the cloths, and the obstacles near them. Where that goes
// far the camera goes along, level: `path` has its place by drawn frame, `box` what it shows at the first one.
function framing(runs) {
  for (const run of runs)
    for (const body of run.obstacles) body.backdrop = isBackdrop(body, run.boxes);
  const run = runs[0], cloth = boundsOf(run.boxes);
  const near = cloth.clone().expandByScalar(0.35 * sizeOf(cloth));
  const bodies = run.obstacles.filter((body) => !body.backdrop && boundsOf(body.boxes).intersectsBox(near));
  const boxAt = (k) => bodies.reduce(
      (box, body) => box.union(boundsOf([body.boxes[body.moving ? k : 0]]).intersect(near)), boundsOf([run.boxes[k]]));
  const boxes = run.boxes.map((_, k) => boxAt(k));
  boxes.forEach((box, k) => k && box.isEmpty() && box.copy(boxes[k - 1]));  // nothing is there: the camera waits
  const all = boxes.reduce((sum, box) => sum.union(box), new THREE.Box3());
  const middles = boxes.map((box) => box.getCenter(new THREE.Vector3()));
  const level = middles.map((middle) => middle.clone().sub(middles[0]).setY(0));
  const path = smoothed(level, run.drawn.map((f) => run.series.time[f]));
  const local = boxes.reduce(
      (sum, box, k) => sum.union(box.clone().translate(path[k].clone().negate())), new THREE.Box3());
  const follows = sizeOf(all) > 1.3 * sizeOf(local), box = follows ? local : all;
  const sphere = box.getBoundingSphere(new THREE.Sphere()), radius = Math.max(sphere.radius, 1e-3);
  const solid = boundsOf(run.obstacles.flatMap((body) => body.boxes));
  const lowest = cloth.isEmpty() ? 0 : Math.min(cloth.min.y, solid.isEmpty() ? Infinity : solid.min.y);
  return {
    centre: sphere.center,
    radius,
    floor: lowest - (run.obstacles.some((b) => b.backdrop) ? 0.05 : 0.004) * radius,
    slender: boxes.filter(isSlender).length > boxes.length / 2,
    points: framedPoints(run, bodies, near, follows ? path : run.drawn.map(() => new THREE.Vector3())),
    path: follows ? path : null
  };
}

// Spacing 1, 2 or 5 times a power of ten near a quarter of the radius.
function gridSpacing(radius) {
  const power = Math.pow(10, Math.floor(Math.log10(radius / 4)));
  return power * [1, 2, 5, 10].find((factor) => factor * power >= radius / 4.2);
}

function makeGrid(frame, spacing) {
  const material = new THREE.ShaderMaterial({
    uniforms: {
      centre: {value: frame.centre.clone()},
      reach: {value: 5 * frame.radius},
      spacing: {value: spacing},
      ink: {value: new THREE.Color(0, 0, 0)},
      strength: {value: 0.15},
    },
    vertexShader: `varying vec3 place;
      void main() {
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      }`,
    fragmentShader: `varying vec3 place; uniform vec3 centre, ink; uniform float reach, spacing, strength;
      float lines(vec2 at, float width) {
        vec2 near = abs(fract(at - 0.5) - 0.5) / (fwidth(at) * width);
        return 1.0 - min(min(near.x, near.y), 1.0);
      }
      void main() {
        float fade = 1.0 - smoothstep(0.1, 1.0, length(place.xz - centre.xz) / reach);
        float line = max(0.55 * lines(place.xz / spacing, 1.0), lines(place.xz / (5.0 * spacing), 1.25));
        gl_FragColor = vec4(ink, line * fade * fade * strength);
      }`,
    extensions: {derivatives: true},
    transparent: true,
    depthWrite: false,
  });
  const r = 5 * frame.radius, geometry = new THREE.BufferGeometry();
  const corner = (x, z) => [frame.centre.x + x * r, frame.floor, frame.centre.z + z * r];
  const corners = [...corner(-1, -1), ...corner(-1, 1), ...corner(1, 1), ...corner(1, -1)];
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(corners), 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(new Float32Array([0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0]), 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const grid = new THREE.Mesh(geometry, material);
  const shadow = new THREE.Mesh(geometry, new THREE.ShadowMaterial({opacity: 0.26, depthWrite: false}));
  shadow.receiveShadow = true;
  shadow.renderOrder = -1;
  return {grid, shadow};
}

function makeLights(frame) {
  const sky = new THREE.HemisphereLight(0xffffff, 0x8d8a86, 0.62);
  const place = (x, y, z) => new THREE.Vector3(x, y, z).normalize().multiplyScalar(3 * frame.radius).add(frame.centre);
  const key = new THREE.DirectionalLight(0xfff6ea, 0.62);
  key.position.copy(place(0.55, 1.25, 0.7));
  key.target.position.copy(frame.centre);
  key.castShadow = true;
  key.shadow.mapSize.set(1536, 1536);
  key.shadow.radius = 3.5;
  key.shadow.bias = -0.0012;
  const r = 1.25 * frame.radius;
  Object.assign(key.shadow.camera, {left: -r, right: r, top: r, bottom: -r, near: frame.radius, far: 6 * frame.radius});
  const fill = new THREE.DirectionalLight(0xdfe9ff, 0.22);
  fill.position.copy(place(-0.9, 0.35, 0.5));
  fill.target.position.copy(frame.centre);
  const rim = new THREE.DirectionalLight(0xffffff, 0.2);
  rim.position.copy(place(-0.2, 0.6, -1));
  rim.target.position.copy(frame.centre);
  return [sky, key, key.target, fill, fill.target, rim, rim.target];
}

function makeStage(canvas, runs) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true});
  renderer.gammaOutput = true;
  renderer.autoClear = false;
  renderer.setClearColor(0x000000, 0);
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFShadowMap;

  const frame = framing(runs), spacing = gridSpacing(frame.radius);
  const figures = runs.map(makeFigure);
  const grids = [];
  const surroundings = [];  // go along with the camera: the lights, the ground
  const scenes = figures.map((figure) => {
    const scene = new THREE.Scene(), around = new THREE.Group(), ground = makeGrid(frame, spacing);
    around.add(ground.shadow, ground.grid, ...makeLights(frame));
    scene.add(figure.group, around);
    surroundings.push(around);
    grids.push(ground.grid.material.uniforms);
    return scene;
  });

  const camera = new THREE.PerspectiveCamera(32, 1, 0.02 * frame.radius, 60 * frame.radius);
  const controls = new THREE.OrbitControls(camera, canvas);
  Object.assign(controls, {
    enableDamping: true,
    dampingFactor: 0.12,
    enableKeys: false,
    screenSpacePanning: true,
    minDistance: 0.05 * frame.radius,
    maxDistance: 20 * frame.radius
  });
  const offset = new THREE.Vector3();  // how far the camera has gone along
  // Camera at an azimuth and elevation in degrees and a distance in units of the one from which the framed points fill
  // a rectangle below its labels.
  function look(azimuth, elevation, distance, {width, height, labels, aside}) {
    const a = THREE.Math.degToRad(azimuth), e = THREE.Math.degToRad(elevation);
    const toward = new THREE.Vector3(Math.sin(a) * Math.cos(e), Math.sin(e), Math.cos(a) * Math.cos(e));
    camera.position.copy(toward);
    camera.lookAt(new THREE.Vector3());
    const right = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion);
    const up = new THREE.Vector3(0, 1, 0).applyQuaternion(camera.quaternion);
    const middle = (axis) => {
      const along = frame.points.map((p) => p.dot(axis));
      return axis.clone().multiplyScalar((along.reduce(smaller, Infinity) + along.reduce(larger, -Infinity)) / 2);
    };
    const centre = frame.points.length ? middle(toward).add(middle(right)).add(middle(up)) : frame.centre.clone();
    const half = Math.tan(THREE.Math.degToRad(camera.fov / 2)), free = (height - labels) / Math.max(1, height);
    const tall = half * free, wide = half * (width - 2 * aside) / Math.max(1, height), from = new THREE.Vector3();
    const away = frame.points.reduce((most, p) => {
      from.copy(p).sub(centre);
      return Math.max(
          most, from.dot(toward) + Math.max(Math.abs(from.dot(up)) / tall, Math.abs(from.dot(right)) / wide));
    }, 1e-3 * frame.radius);
    controls.target.copy(centre.add(offset));
    camera.position.copy(toward).multiplyScalar(1.06 * distance * away).add(centre);
    controls.update();
  }
  // Takes the camera, wherever the user has turned it, along with the first run's drawn frame.
  function follow(drawn) {
    if (!frame.path) return;
    const step = frame.path[drawn].clone().sub(offset);
    offset.add(step);
    camera.position.add(step);
    controls.target.add(step);
    grids.forEach((uniforms) => uniforms.centre.value.copy(frame.centre).add(offset));
    surroundings.forEach((around) => around.position.copy(offset));
  }

  function resize() {
    renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
  }
  // Draws every scene into its rectangle, given in CSS pixels of the canvas with the height of its labels and how
  // far the figure stands to the right of the middle.
  function draw(rectangles) {
    renderer.setScissorTest(false);
    renderer.clear();
    renderer.setScissorTest(true);
    scenes.forEach((scene, i) => {
      const {left, top, width, height, labels, aside} = rectangles[i];
      if (width < 1 || height < 1) return;
      const bottom = canvas.clientHeight - top - height;
      renderer.setViewport(left, bottom, width, height);
      renderer.setScissor(left, bottom, width, height);
      const away = camera.position.distanceTo(controls.target);
      figures[i].outline(height / (2 * away * Math.tan(THREE.Math.degToRad(camera.fov / 2))));
      camera.setViewOffset(width, height, -aside, -labels / 2, width, height);
      renderer.render(scene, camera);
    });
  }
  function setDark(dark) {
    grids.forEach((uniforms) => {
      uniforms.ink.value.setScalar(dark ? 1 : 0);
      uniforms.strength.value = dark ? 0.13 : 0.15;
    });
  }
  return {renderer, camera, controls, figures, spacing, slender: frame.slender, look, follow, resize, draw, setDark};
}
