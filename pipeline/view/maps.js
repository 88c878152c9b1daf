// Colours by numbers of the vertices, which a report gave or which a run has in each frame, their legend, and the
// report's table.

// Whether a report gave the maps. They take the place of the strain, and are shown at first.
const isReport = (runs) => runs[0].maps.some((map) => !map.changes);

// The map that colours a run; none where the strain does.
const mapOf = (run, look) => (look.strain ? undefined : run.maps[look.map]);

function bindMaps(page) {
  const {look, runs} = page, strain = element("strain");
  const buttons = runs[0].maps.map((map, m) => {
    const button = document.createElement("button");
    button.textContent = map.name[0].toUpperCase() + map.name.slice(1);
    button.title = `Colour by ${map.name}`;
    button.addEventListener("click", () => {
      const shown = mapOf(runs[0], look) === map;
      look.map = shown ? -1 : m;
      look.strain = false;
      page.redraw();
    });
    strain.before(button);
    return button;
  });
  page.showMaps = () => {
    buttons.forEach((button, m) => button.setAttribute("aria-pressed", mapOf(runs[0], look) === runs[0].maps[m]));
    strain.setAttribute("aria-pressed", look.strain);
  };
  strain.hidden = isReport(runs);
  page.showMaps();
}

function showLegend(run, look) {
  const map = mapOf(run, look);
  element("legend").hidden = !map && !look.strain;
  element("legend-title").textContent = map ? `${map.name} [${map.unit}]` : "principal stretch";
  element("legend-low").textContent = map ? short(map.low) : "1.00";
  element("legend-high").textContent = map ? short(map.high) : "";
  element("legend-high").hidden = !map;
  element("legend-top").hidden = Boolean(map);
}

function showTable(table) {
  if (!table.rows.length) return;
  const line = (texts, kind) => {
    const row = document.createElement("tr");
    row.append(...texts.map((text) => {
      const cell = document.createElement(kind);
      cell.textContent = text;
      return cell;
    }));
    return row;
  };
  const drawn = document.createElement("table");
  drawn.append(line(table.titles, "th"), ...table.rows.map((row) => line(row, "td")));
  element("table").append(drawn);
  element("table").hidden = false;
  document.body.classList.add("with-table");
}
