#include "pipeline/scene/setup_outcome.hpp"

#include "pipeline/scene/setup_selection.hpp"

namespace selvedge {
namespace {

struct Parts {
  const std::vector<ClothPart>& cloths;
  const Scene& scene;
};

// Vertices of the scene.
std::vector<int> selected(const Config& section, const Parts& parts) {
  const bool part = section.given && (section["vertices"].given || section["box"].given || section["group"].given);
  const bool named = section.given && section["cloth"].given;
  if (part && !named && parts.cloths.size() > 1) section.fail("does not say of which cloth", "name the `cloth`");
  std::vector<int> all;
  for (std::size_t c = 0; c < parts.cloths.size(); ++c) {
    if (named && index_of(section["cloth"], parts.cloths) != static_cast<int>(c)) continue;
    const Cloth& cloth = parts.scene.cloths[c];
    if (part)
      for (const int v : read_selection(section, parts.cloths[c])) all.push_back(cloth.first_vertex + v);
    else
      for (int v = 0; v < cloth.vertex_count; ++v) all.push_back(cloth.first_vertex + v);
  }
  return all;
}

Vec3 direction(const Config& value) {
  const Vec3 v = value.vector();
  if (v.norm() == 0) value.fail("has no direction", "give a vector of any length");
  return v.normalized();
}

Measure read_measure(const Config& section, const Parts& parts) {
  if (const Config& m = section["outside"]; m.given)
    return OutsideBox{selected(m["of"], parts), m["min"].vector(), m["max"].vector()};
  if (const Config& m = section["turns"]; m.given)
    return Turns{selected(m["of"], parts), m["against"].given ? selected(m["against"], parts) : std::vector<int>{},
                 direction(m["axis"])};
  if (const Config& m = section["distance"]; m.given)
    return PartsApart{selected(m["from"], parts), selected(m["to"], parts),
                      m["along"].given ? direction(m["along"]) : Vec3(0, 0, 0)};
  if (const Config& m = section["disorder"]; m.given) return Disorder{direction(m["up"])};
  if (const Config& m = section["ahead"]; m.given)
    return Ahead{selected(m["of"], parts), index_of(m["obstacle"], parts.scene.obstacles), direction(m["direction"]),
                 m["radius"].number()};
  if (const Config& m = section["drift"]; m.given) return Drift{selected(m["of"], parts)};
  if (section["stretch"].given) return LargestStretch{};
  if (const Config& m = section["lag"]; m.given) {
    if (!m["obstacle"].given) return Lag{};
    return Lag{index_of(m["obstacle"], parts.scene.obstacles)};
  }
  return WantedPairs{};
}

}  // namespace

std::vector<Outcome> read_outcomes(const Config& list, const std::vector<ClothPart>& cloths, const Scene& scene) {
  std::vector<Outcome> outcomes;
  for (const Config& section : list.items) {
    Outcome outcome{section["name"].text(), read_measure(section, {cloths, scene})};
    if (section["from"].given) outcome.from = section["from"].number();
    if (section["until"].given) outcome.until = section["until"].number();
    if (outcome.until && *outcome.until < outcome.from.value_or(0))
      section["until"].fail("is before `from`", "swap them");
    if (section["least"].given) outcome.least = section["least"].number();
    if (section["most"].given) outcome.most = section["most"].number();
    if (!section["least"].given && !section["most"].given) outcome.most = 0;
    outcome.once = section["hold"].text() == "once";
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

}  // namespace selvedge
