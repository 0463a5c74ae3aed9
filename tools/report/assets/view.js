// The sand under the foot in three dimensions. Reads the JSON of the element "fields-view", which
// tools/fields/field_view.cpp writes (see there), and draws into the element "view" with three.js.
// Nothing is drawn unless something changed.
(() => {
  const source = document.getElementById("fields-view");
  const box = document.getElementById("view");
  if (!source || !box) return;
  const say = (text) => { box.querySelector(".message").textContent = text; };
  const data = JSON.parse(source.textContent);
  let renderer;
  try {
    renderer = new three.WebGLRenderer({ antialias: true });
  } catch (error) {
    say("This view needs WebGL, which this browser does not give.");
    return;
  }

  const shorts = (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Uint16Array(bytes.buffer);
  };
  const size = data.high_m.map((high, axis) => high - data.low_m[axis]);
  const place = (values, at, target) => target.set(
    data.low_m[0] + values[at] / 65535 * size[0],
    data.low_m[1] + values[at + 1] / 65535 * size[1],
    data.low_m[2] + values[at + 2] / 65535 * size[2]);

  const stops = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779",
    "#6ece58", "#b5de2b", "#fde725"].map((text) => new three.Color(text));
  function viridis(share, target) {
    const at = Math.min(Math.max(share, 0), 1) * 9, stop = Math.min(8, Math.floor(at));
    return target.copy(stops[stop]).lerp(stops[stop + 1], at - stop);
  }

  // Of a grain's seven numbers, the one that colours it; what a full bar means.
  const colourings = {
    speed: { at: 4, text: `${(1e3 * data.speed_m_s).toPrecision(3)} mm/s` },
    displacement: { at: 5, text: `${(1e3 * data.displacement_m).toPrecision(3)} mm` },
    force: { at: 6, text: `${data.force_N.toPrecision(3)} N, largest contact` },
  };
  const pressureText = `foot: 0 to ${(1e-3 * data.pressure_Pa).toPrecision(3)} kPa by triangle`;

  const scene = new three.Scene();
  const camera = new three.PerspectiveCamera(35, 1, 0.005, 10);
  camera.up.set(0, 0, 1);
  scene.add(new three.AmbientLight(0xffffff, 1.6));
  const lamp = new three.DirectionalLight(0xffffff, 2.2);
  lamp.position.set(-1, -2, 3);
  scene.add(lamp);
  const cutPlane = new three.Plane(new three.Vector3(0, 1, 0), 0);  // keeps y above the cut
  renderer.localClippingEnabled = true;
  renderer.setClearColor(0xffffff, 1);
  box.querySelector(".canvas").append(renderer.domElement);

  const most = Math.max(...data.moments.map((m) => shorts(m.grains).length / 7));
  const grains = new three.InstancedMesh(
    new three.IcosahedronGeometry(1, most > 6000 ? 1 : 2),
    new three.MeshLambertMaterial(), most);
  grains.frustumCulled = false;
  scene.add(grains);

  const chainMaterial = new three.MeshBasicMaterial();
  const chains = new three.InstancedMesh(new three.CylinderGeometry(1, 1, 1, 5, 1, true),
    chainMaterial, Math.max(1, ...data.moments.map((m) => shorts(m.chains).length / 7)));
  chains.frustumCulled = false;
  scene.add(chains);

  const bodies = data.bodies.map((body) => {
    const geometry = new three.BufferGeometry();
    const corners = new Float32Array(3 * body.triangles.length);
    body.triangles.forEach((vertex, k) => {
      for (let axis = 0; axis < 3; ++axis) corners[3 * k + axis] = body.vertices_m[3 * vertex + axis];
    });
    geometry.setAttribute("position", new three.BufferAttribute(corners, 3));
    geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(corners.length), 3));
    geometry.computeVertexNormals();
    const mesh = new three.Mesh(geometry, new three.MeshLambertMaterial({
      vertexColors: true, side: three.DoubleSide, transparent: true, clippingPlanes: [cutPlane] }));
    mesh.triangles = body.triangles.length / 3;
    scene.add(mesh);
    return mesh;
  });

  const controls = new three.OrbitControls(camera, renderer.domElement);
  const input = (name) => box.querySelector(`[name=${name}]`);
  const matrix = new three.Matrix4(), colour = new three.Color();
  const from = new three.Vector3(), to = new three.Vector3(), middle = new three.Vector3();
  const up = new three.Vector3(0, 1, 0), along = new three.Vector3(), scale = new three.Vector3();
  const turn = new three.Quaternion();

  // Those before the cut are left out whole: a grain cut open would be hollow.
  function showGrains(moment) {
    const values = shorts(moment.grains);
    const at = colourings[input("colour").value].at, cut_m = 1e-3 * Number(input("cut").value);
    grains.count = 0;
    for (let i = 0; i < values.length; i += 7) {
      place(values, i, from);
      if (from.y < cut_m) continue;
      const radius_m = values[i + 3] / 65535 * data.radius_m;
      matrix.makeScale(radius_m, radius_m, radius_m).setPosition(from);
      grains.setMatrixAt(grains.count, matrix);
      grains.setColorAt(grains.count++, viridis(values[i + at] / 65535, colour));
    }
    grains.instanceMatrix.needsUpdate = true;
    if (grains.instanceColor) grains.instanceColor.needsUpdate = true;
  }

  // The strong ones: above the mean of those that are kept, as wide as they press.
  function showChains(moment) {
    const values = shorts(moment.chains);
    let mean = 0;
    for (let i = 6; i < values.length; i += 7) mean += values[i] * 7 / values.length;
    chains.count = 0;
    for (let i = 0; i < values.length; i += 7) {
      if (!(values[i + 6] > mean)) continue;
      place(values, i, from);
      place(values, i + 3, to);
      middle.addVectors(from, to).multiplyScalar(0.5);
      along.subVectors(to, from);
      const length_m = along.length(), share = values[i + 6] / 65535;
      const width_m = data.radius_m * (0.04 + 0.28 * share);
      turn.setFromUnitVectors(up, along.divideScalar(length_m || 1));
      matrix.compose(middle, turn, scale.set(width_m, length_m, width_m));
      chains.setMatrixAt(chains.count, matrix);
      chains.setColorAt(chains.count++, viridis(share, colour));
    }
    chains.instanceMatrix.needsUpdate = true;
    if (chains.instanceColor) chains.instanceColor.needsUpdate = true;
  }

  function showFoot(moment) {
    const values = shorts(moment.pressure);
    let first = 0;
    bodies.forEach((mesh, k) => {
      const [x, y, z, qx, qy, qz, qw] = moment.poses[k];
      mesh.position.set(x, y, z);
      mesh.quaternion.set(qx, qy, qz, qw);
      const colours = mesh.geometry.getAttribute("color");
      for (let t = 0; t < mesh.triangles; ++t) {
        const pressed = values[first + t] > 0;
        if (pressed) viridis(values[first + t] / 65535, colour); else colour.set("#b9c0c7");
        for (let c = 0; c < 3; ++c) colours.setXYZ(3 * t + c, colour.r, colour.g, colour.b);
      }
      colours.needsUpdate = true;
      first += mesh.triangles;
    });
  }

  function draw() {
    const canvas = box.querySelector(".canvas");
    const width = canvas.clientWidth, height = Math.round(Math.min(560, 0.6 * width));
    renderer.setPixelRatio(devicePixelRatio);
    renderer.setSize(width, height);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    renderer.render(scene, camera);
    box.dataset.triangles = renderer.info.render.triangles;
  }

  function show() {
    const index = Number(input("moment").value), moment = data.moments[index];
    cutPlane.constant = -1e-3 * Number(input("cut").value);
    grains.visible = input("grains").checked;
    chains.visible = input("chains").checked;
    for (const mesh of bodies) {
      mesh.visible = input("foot").checked;
      mesh.material.opacity = chains.visible && !grains.visible ? 0.5 : 1;
      mesh.material.depthWrite = mesh.material.opacity === 1;
    }
    showGrains(moment);
    showChains(moment);
    showFoot(moment);
    const since_s = moment.time_s - data.moments[0].time_s;
    say(`${moment.name}, ${(1e3 * since_s).toFixed(0)} ms after first contact`);
    box.querySelector(".bar-end").textContent =
      `${colourings[input("colour").value].text}; ${pressureText}`;
    box.dataset.grains = grains.count;
    box.dataset.chains = chains.count;
    box.dataset.moment = moment.name;
    draw();
  }

  input("moment").max = data.moments.length - 1;
  const first = data.moments.findIndex((m) => m.name === "greatest depth" || m.name === "peak Fx");
  input("moment").value = first < 0 ? data.moments.length - 1 : first;
  // Half of the sand is in front of the cut at first, so that its inside is seen.
  const foot_m = data.moments[Number(input("moment").value)].poses[0];
  const half_mm = Math.round(500 * size[1]);
  Object.assign(input("cut"), { min: -half_mm, max: half_mm, value: 0 });
  controls.target.set(foot_m[0], foot_m[1], foot_m[2] - 0.03);
  camera.position.set(foot_m[0] + 0.10, foot_m[1] - 0.42, foot_m[2] + 0.09);
  controls.update();
  controls.addEventListener("change", draw);
  addEventListener("resize", draw);
  box.querySelector("form").addEventListener("input", show);
  show();
})();
