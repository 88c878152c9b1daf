// Colours by numbers that a report gave to the vertices, their legend, and the report's table.

function bindMaps(page) {
  const {look, runs} = page, strain = element("strain");
  const buttons = runs[0].maps.map((map, m) => {
    const button = document.createElement("button");
    button.textContent = map.name;
    button.title = `Colour by ${map.name}`;
    button.addEventListener("click", () => {
      look.map = look.map === m ? -1 : m;
      show();
      page.redraw();
    });
    strain.before(button);
    return button;
  });
  function show() {
    buttons.forEach((button, m) => button.setAttribute("aria-pressed", look.map === m));
  }
  strain.hidden = buttons.length > 0;
  show();
}

function showLegend(run, look) {
  const map = run.maps[look.map];
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
