// A run's panel: its name and labels over the drawing, its plots below.

function makePanel(run, scaleText) {
  const panel = document.createElement("section");
  panel.className = "panel";
  panel.innerHTML = `
    <div class="view">
      <div class="name"></div><div class="detail"></div><div class="chips"></div><div class="scale"></div>
    </div>
    <div class="charts"></div>`;
  panel.querySelector(".name").textContent = run.name;
  panel.querySelector(".scale").textContent = scaleText;
  const drawnEvery = run.drawn.length < run.frames ? `, drawn every ${run.drawn[1] - run.drawn[0]} frames` : "";
  const count = (n, what) => `${n.toLocaleString("en")} ${what}`;
  panel.querySelector(".detail").textContent = `${run.stepper} \u00b7 ${count(run.vertices, "vertices")}, ` +
      `${count(run.triangles.length / 3, "triangles")}${drawnEvery}`;
  return {
    panel,
    view: panel.querySelector(".view"),
    chips: panel.querySelector(".chips"),
    charts: panel.querySelector(".charts")
  };
}

const NOT_CONVERGED = "Solves ended so far at most (RMS over the vertices) from where exact ones would end. "
  + "Contact holds as in every other frame.";

// What is worth saying about a frame, most important first: [text, class, and where it needs one an explanation].
function chipsOf(run, frame, marked) {
  const at = (name) => run.series[name][frame];
  const words = (name) => (name === "none" ? "" : name.replace(/_/g, " "));
  const range = ["min_stretch", "max_stretch"].map((name) => (at(name) === null ? "\u2013" : at(name).toFixed(3)));
  const plural = (n, word) => `${n} ${n === 1 ? word : word.replace(/ex$/, "ice")}${n === 1 ? "" : "s"}`;
  const chips = [], pairs = run.pairs[frame];
  if (at("nonfinite")) chips.push([`${plural(at("nonfinite"), "vertex")} not finite`, "bad"]);
  if (pairs) chips.push([`${plural(pairs, "intersecting pair")}, ${plural(marked, "triangle")} marked`, "bad"]);
  else chips.push([run.selfAudited ? "0 intersecting pairs" : "0 pairs with obstacles", "good"]);
  if (!run.selfAudited) chips.push(["self: not audited", "warn"]);
  if (at("vertex_pairs")) chips.push([`${plural(at("vertex_pairs"), "pair")} crossing at a shared vertex`, "warn"]);
  if (at("inside_vertices")) chips.push([`${plural(at("inside_vertices"), "vertex")} inside an obstacle`, "bad"]);
  at("switched_off").forEach((count, b) => {
    if (count) chips.push([`${plural(count, "triangle")} of ${run.obstacles[b].name} switched off`, "warn"]);
  });
  if (at("pushed_out")) chips.push([`${plural(at("pushed_out"), "vertex")} pushed out`, ""]);
  if (at("out_of_newton")) chips.push(["out of Newton iterations", "warn"]);
  if (at("out_of_untangling")) chips.push(["out of untangling passes", "warn"]);
  if (at("out_of_response")) chips.push(["out of response", "warn"]);
  if (at("out_of_proofs")) chips.push(["out of proofs", "warn"]);
  const refused = words(at("verdict")), reason = words(at("reason"));
  if (at("fell_back")) chips.push([`fell back${refused ? `: ${refused}` : ""}`, "warn"]);
  if (reason) chips.push([`rejected: ${reason}`, "bad"]);
  run.doubts.filter(at).forEach((name) => {
    if (name !== "not_converged" || !at("unsolved")) chips.push([words(name), "warn"]);
    else chips.push([`not converged: ${(1000 * at("unsolved")).toFixed(1)} mm`, "warn", NOT_CONVERGED]);
  });
  if (at("by") && at("by") !== run.stepper) chips.push([`by ${at("by")}`, ""]);
  chips.push([`stretch ${range[0]} to ${range[1]}`, ""]);
  if (at("contacts")) chips.push([plural(at("contacts"), "contact"), ""]);
  if (frame === run.frames - 1 && run.ended) chips.push(["ended", ""]);
  return chips;
}

function showChips(parent, chips) {
  parent.replaceChildren(...chips.map(([text, kind, why = ""]) => {
    const chip = document.createElement("span");
    chip.className = `chip ${kind}`;
    chip.textContent = text;
    chip.title = why;
    return chip;
  }));
}
