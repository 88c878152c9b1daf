// What one run draws: its cloths, marks, pins and obstacles, brought to a frame.

function surfaceGeometry(vertices, triangles) {
  const geometry = new THREE.BufferGeometry();
  const attribute = () => new THREE.BufferAttribute(new Float32Array(3 * vertices), 3);
  geometry.setAttribute("position", attribute());
  geometry.setAttribute("normal", attribute());
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  return geometry;
}

// Area-weighted vertex normals; a triangle with a corner that is not finite gives none.
function updateNormals(geometry) {
  const x = geometry.attributes.position.array, n = geometry.attributes.normal.array, t = geometry.index.array;
  n.fill(0);
  for (let i = 0; i < t.length; i += 3) {
    const a = 3 * t[i], b = 3 * t[i + 1], c = 3 * t[i + 2];
    const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
    const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
    const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    if (!(nx * nx + ny * ny + nz * nz > 0)) continue;
    for (const v of [a, b, c]) {
      n[v] += nx;
      n[v + 1] += ny;
      n[v + 2] += nz;
    }
  }
  for (let i = 0; i < n.length; i += 3) {
    const length = Math.hypot(n[i], n[i + 1], n[i + 2]) || 1;
    n[i] /= length;
    n[i + 1] /= length;
    n[i + 2] /= length;
  }
  geometry.attributes.position.needsUpdate = geometry.attributes.normal.needsUpdate = true;
}

// Larger principal stretch of triangle t: the root of the larger eigenvalue of H G (see inverse_rest_metric).
function stretchOf(x, triangles, metric, t) {
  const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
  const ux = x[b] - x[a], uy = x[b + 1] - x[a + 1], uz = x[b + 2] - x[a + 2];
  const vx = x[c] - x[a], vy = x[c + 1] - x[a + 1], vz = x[c + 2] - x[a + 2];
  const g00 = ux * ux + uy * uy + uz * uz, g01 = ux * vx + uy * vy + uz * vz, g11 = vx * vx + vy * vy + vz * vz;
  const h00 = metric[3 * t], h01 = metric[3 * t + 1], h11 = metric[3 * t + 2];
  const half = (h00 * g00 + 2 * h01 * g01 + h11 * g11) / 2;
  const determinant = (h00 * h11 - h01 * h01) * (g00 * g11 - g01 * g01);
  return Math.sqrt(half + Math.sqrt(Math.max(0, half * half - determinant)));
}

// Vertex colours: mean of the triangles round a vertex, on the table between 1 and `top`.
function colourByStretch(geometry, metric, top, table) {
  const x = geometry.attributes.position.array, t = geometry.index.array, vertices = x.length / 3;
  if (!geometry.attributes.color)
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(x.length), 3));
  const sum = new Float32Array(vertices), count = new Uint16Array(vertices);
  for (let i = 0; 3 * i < t.length; ++i) {
    const stretch = stretchOf(x, t, metric, i);
    if (!isFinite(stretch)) continue;
    for (let k = 0; k < 3; ++k) {
      sum[t[3 * i + k]] += stretch;
      ++count[t[3 * i + k]];
    }
  }
  const colours = geometry.attributes.color.array;
  for (let v = 0; v < vertices; ++v) {
    const at = Math.min(1, Math.max(0, (sum[v] / (count[v] || 1) - 1) / (top - 1)));
    const entry = 3 * Math.round(255 * at);
    for (let k = 0; k < 3; ++k) colours[3 * v + k] = table[entry + k];
  }
  geometry.attributes.color.needsUpdate = true;
}

// Vertex colours by a map's values, from its low to its high; grey where there is none.
function colourByMap(geometry, map, drawn, table) {
  const vertices = geometry.attributes.position.count, valueOf = map.at(drawn);
  if (!geometry.attributes.color)
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * vertices), 3));
  const colours = geometry.attributes.color.array;
  for (let v = 0; v < vertices; ++v) {
    const value = valueOf(v), at = Math.min(1, Math.max(0, (value - map.low) / (map.high - map.low || 1)));
    for (let k = 0; k < 3; ++k) colours[3 * v + k] = isFinite(value) ? table[3 * Math.round(255 * at) + k] : 0.4;
  }
  geometry.attributes.color.needsUpdate = true;
}

// Fabric scatters light at grazing angles: a soft rim added to the standard material.
function addSheen(material) {
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
        "gl_FragColor = vec4( outgoingLight, diffuseColor.a );",
        `float grazing = 1.0 - abs(dot(normalize(normal), normalize(vViewPosition)));
      outgoingLight += 0.22 * pow(grazing, 3.0) * mix(diffuseColor.rgb, vec3(1.0), 0.35);
      gl_FragColor = vec4( outgoingLight, diffuseColor.a );`);
  };
  return material;
}

function clothMaterials(run, side) {
  const names = side === THREE.FrontSide ? "front" : "back";
  const firsts = run.clothFirstTriangle.slice(0, -1);
  return firsts.map((_, i) => addSheen(new THREE.MeshStandardMaterial({
                      color: linear(clothColours[i % clothColours.length][names]),
                      roughness: 0.78,
                      metalness: 0,
                      side,
                      polygonOffsetFactor: 1,
                      polygonOffsetUnits: 1,
                    })));
}

// Red triangles on the surface, and through it where something hides them. White edges tell them from any cloth, also
// for eyes to which red and orange are alike.
function markMeshes(geometry, most) {
  const marks = new THREE.BufferGeometry();
  marks.setAttribute("position", geometry.attributes.position);
  marks.setIndex(new THREE.BufferAttribute(new Uint32Array(3 * most), 1));
  marks.setDrawRange(0, 0);
  const red = {color: linear("#ff1e1e"), side: THREE.DoubleSide};
  const seen = new THREE.Mesh(
      marks,
      new THREE.MeshBasicMaterial({...red, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -2}));
  const hidden = new THREE.Mesh(
      marks,
      new THREE.MeshBasicMaterial({...red, transparent: true, opacity: 0.45, depthTest: false, depthWrite: false}));
  const edges = new THREE.Mesh(
      marks,
      new THREE.MeshBasicMaterial(
          {color: 0xffffff, wireframe: true, transparent: true, opacity: 0.8, depthTest: false}));
  hidden.renderOrder = 2;
  edges.renderOrder = 3;
  return [seen, hidden, edges];
}

// Mean edge of the rest shape, as if its triangles were equilateral; 1 / (2 area)^2 is the determinant of the metric.
// Triangles of which rounding leaves no area do not count.
function edgeLength(metric) {
  let area = 0, count = 0;
  for (let i = 0; i < metric.length; i += 3) {
    const determinant = metric[i] * metric[i + 2] - metric[i + 1] * metric[i + 1];
    if (!(determinant > 0)) continue;
    area += 0.5 / Math.sqrt(determinant);
    ++count;
  }
  return Math.sqrt(area / Math.max(1, count) * 4 / Math.sqrt(3));
}

// Round heads that are a third of an edge wide. They lie flat on their cloth, so that cloth worn over a pinned waist
// covers them, also where it is seen at a slant.
function pinHeads(run, geometry, edge) {
  const corners = 12, pins = run.pins, index = [];
  for (let p = 0; p < pins.length; ++p)
    for (let k = 1; k + 1 < corners; ++k) index.push(corners * p, corners * p + k, corners * p + k + 1);
  const heads = new THREE.BufferGeometry();
  heads.setAttribute("position", new THREE.BufferAttribute(new Float32Array(3 * corners * pins.length), 3));
  heads.setIndex(index);
  const mesh = new THREE.Mesh(heads, new THREE.MeshBasicMaterial({
    color: linear("#f9f9f9"),
    side: THREE.DoubleSide,
    polygonOffset: true,
    polygonOffsetFactor: 0,
    polygonOffsetUnits: -2
  }));
  const at = heads.attributes.position, along = new THREE.Vector3(), across = new THREE.Vector3(),
        normal = new THREE.Vector3(), centre = new THREE.Vector3();
  // Puts the heads where the cloth is. A head is at least two pixels wide; `pixels`: of a metre.
  function move(pixels) {
    const radius = Math.max(0.175 * edge, 1 / pixels);
    for (let p = 0; p < pins.length; ++p) {
      centre.fromArray(geometry.attributes.position.array, 3 * pins[p]);
      normal.fromArray(geometry.attributes.normal.array, 3 * pins[p]);
      along.set(normal.y, normal.z, normal.x).cross(normal).normalize();
      across.crossVectors(normal, along);
      for (let k = 0; k < corners; ++k) {
        const angle = 2 * Math.PI * k / corners, u = radius * Math.cos(angle), v = radius * Math.sin(angle);
        at.setXYZ(corners * p + k, centre.x + u * along.x + v * across.x, centre.y + u * along.y + v * across.y,
                  centre.z + u * along.z + v * across.z);
      }
    }
    at.needsUpdate = true;
  }
  return {mesh, move};
}

// Builds the objects of one run in a group and returns them with `show(drawn, look)`.
function makeFigure(run) {
  const group = new THREE.Group(), table = strainTable(true);
  const geometry = surfaceGeometry(run.vertices, run.triangles);
  const firsts = run.clothFirstTriangle;
  for (let c = 0; c + 1 < firsts.length; ++c) geometry.addGroup(3 * firsts[c], 3 * (firsts[c + 1] - firsts[c]), c);
  const sides = [THREE.FrontSide, THREE.BackSide].map((side) => new THREE.Mesh(geometry, clothMaterials(run, side)));
  const base = sides.map((mesh) => mesh.material.map((material) => material.color.clone()));
  sides.forEach((mesh) => {
    mesh.receiveShadow = true;
  });
  sides[0].castShadow = true;
  sides[0].material.forEach((material) => {
    material.shadowSide = THREE.DoubleSide;
  });
  const wire = new THREE.Mesh(
      geometry, new THREE.MeshBasicMaterial({color: 0x0c1118, wireframe: true, transparent: true, opacity: 0.34}));
  const marks = markMeshes(geometry, Math.max(1, ...run.marked.map((list) => list.length)));
  group.add(...sides, wire, ...marks);

  const edge = edgeLength(run.metric), heads = pinHeads(run, geometry, edge);
  group.add(heads.mesh);

  const bodies = run.obstacles.map((body) => {
    const mesh = new THREE.Mesh(surfaceGeometry(body.vertices, body.triangles), new THREE.MeshStandardMaterial({
      color: linear("#b9bdc2"),
      roughness: 0.9,
      metalness: 0,
      side: THREE.DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 2
    }));
    mesh.receiveShadow = true;
    mesh.castShadow = !body.backdrop;
    group.add(mesh);
    return mesh;
  });
  // Bounds change with every frame and the whole figure is nearly always in view.
  group.traverse((object) => {
    object.frustumCulled = false;
  });

  // Edges appear where they leave something of a triangle to be seen: from ten pixels to twenty. `pixels`: of a metre.
  function outline(pixels) {
    marks[2].material.opacity = 0.8 * Math.min(1, Math.max(0, pixels * edge / 10 - 1));
    if (drawn !== pinned.drawn || pixels !== pinned.pixels) heads.move(pixels);
    pinned = {drawn, pixels};
  }

  let drawn = -1, pinned = {};
  function moveTo(next) {
    unpack(run.positions, next, geometry.attributes.position.array);
    updateNormals(geometry);
    bodies.forEach((mesh, b) => {
      const body = run.obstacles[b];
      if (!body.moving && drawn >= 0) return;
      unpack(body.positions, body.moving ? next : 0, mesh.geometry.attributes.position.array);
      updateNormals(mesh.geometry);
    });
    const index = marks[0].geometry.index;
    run.marked[next].forEach((t, i) => index.array.set(run.triangles.subarray(3 * t, 3 * t + 3), 3 * i));
    marks[0].geometry.setDrawRange(0, 3 * run.marked[next].length);
    index.needsUpdate = true;
    drawn = next;
  }
  function show(next, look) {
    if (next !== drawn) moveTo(next);
    const map = mapOf(run, look), coloured = map || look.strain;
    if (map)
      colourByMap(geometry, map, next, table);
    else if (look.strain) colourByStretch(geometry, run.metric, look.strainTop, table);
    sides.forEach((mesh, s) => mesh.material.forEach((material, c) => {
      const mode = coloured ? THREE.VertexColors : THREE.NoColors;
      if (material.vertexColors !== mode) {
        material.vertexColors = mode;
        material.needsUpdate = true;
      }
      // Lines need to lie before the cloth; without them it stays where it is, or what is seen at a slant goes behind
      // what it is worn over.
      material.polygonOffset = look.wire;
      material.color.copy(base[s][c]);
      if (coloured) material.color.setScalar(1);
    }));
    wire.visible = look.wire;
    marks.forEach((mesh) => {
      mesh.visible = look.marks;
    });
  }
  return {group, show, outline};
}
