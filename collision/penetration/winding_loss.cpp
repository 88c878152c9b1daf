#include "collision/penetration/winding_loss.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/geometry/disjoint_sets.hpp"
#include "collision/penetration/clipped_faces.hpp"
#include "collision/penetration/dipole_tree.hpp"
#include "collision/penetration/face_cells.hpp"

namespace selvedge {
namespace {

// A turn for each triangle such that the closed components have positive volume: normals point outward.
std::vector<signed char> outward_turns(const ClosedSurface& closed, const Points& x) {
  const Surface& surface = closed.surface;
  std::vector<double> volume(static_cast<std::size_t>(surface.component_count), 0);
  std::vector<Vec3> origin(volume.size());
  std::vector<char> known(volume.size(), 0);
  for (int t = 0; t < surface.triangles.rows(); ++t) {
    const Vec3 a = row(x, surface.triangles(t, 0));
    const int component = surface.component[surface.triangles(t, 0)];
    if (!known[component]) origin[component] = a;
    known[component] = 1;
    const Vec3 b = row(x, surface.triangles(t, 1)) - a, c = row(x, surface.triangles(t, 2)) - a;
    volume[component] += closed.turn[t] * (a - origin[component]).dot(b.cross(c));
  }
  std::vector<signed char> turns = closed.turn;
  for (int t = 0; t < surface.triangles.rows(); ++t)
    if (volume[surface.component[surface.triangles(t, 0)]] < 0) turns[t] = static_cast<signed char>(-turns[t]);
  return turns;
}

// The cells of a face between crossings, and the weight of each.
struct WeighedFace {
  int face = 0;
  std::vector<FaceCell> cells;
  std::vector<double> weights;
};

class GarmentWinding {
 public:
  GarmentWinding(const ClosedSurface& closed, const Points& x, const Segments& found,
                 const std::vector<signed char>& turn, const std::vector<int>& faces, double far)
      : closed_(closed),
        surface_(closed.surface),
        x_(x),
        found_(found),
        tree_(make_dipole_tree(surface_, x, faces, turn, far)) {}

  // The faces that count, and those next to them, which have weights 0.
  std::vector<WeighedFace> reach(const std::vector<std::array<int, 2>>& pairs, const std::vector<int>& segments) {
    for (const int s : segments)
      for (const int face : found_.segments[s].triangle) chords_[face].push_back(s);
    std::vector<WeighedFace> all;
    std::vector<int> front;
    std::vector<char> seen(static_cast<std::size_t>(surface_.triangles.rows()), 0);
    const auto add = [&](int face) {
      if (seen[face] || closed_.is_fan(face)) return;
      seen[face] = 1;
      front.push_back(face);
    };
    for (const auto& pair : pairs)
      for (const int face : pair) add(face);
    while (!front.empty()) {
      std::vector<WeighedFace> weighed = weigh(front);
      front.clear();
      for (const WeighedFace& face : weighed)
        for (std::size_t c = 0; c < face.cells.size(); ++c)
          for (int k = 0; k < 3; ++k)
            if (face.weights[c] != 0 && face.cells[c].at_edge[k])
              for (const int next : surface_.edge_triangles[surface_.triangle_edges(face.face, k)])
                if (next >= 0) add(next);
      std::ranges::move(weighed, std::back_inserter(all));
    }
    return all;
  }

 private:
  // The weights of the cells of some faces, from the winding number at the cell's middle.
  std::vector<WeighedFace> weigh(const std::vector<int>& faces) const {
    std::vector<WeighedFace> weighed;
    std::vector<WindingPoint> points;
    for (const int face : faces) {
      weighed.push_back({face, face_cells(chords_in(face)), {}});
      for (const FaceCell& cell : weighed.back().cells) {
        points.push_back({Vec3::Zero(), face});
        for (int k = 0; k < 3; ++k) points.back().at += cell.middle[k] * row(x_, surface_.triangles(face, k));
      }
    }
    const std::vector<double> numbers = winding_numbers(tree_, points);
    auto winding = numbers.begin();
    for (WeighedFace& face : weighed)
      for (std::size_t c = 0; c < face.cells.size(); ++c, ++winding)
        face.weights.push_back(winding_cost(*winding + 0.5) - winding_cost(*winding - 0.5));
    return weighed;
  }

  std::vector<FaceChord> chords_in(int face) const {
    std::vector<FaceChord> chords;
    const auto found = chords_.find(face);
    if (found == chords_.end()) return chords;
    for (const int s : found->second) {
      const Segment& segment = found_.segments[s];
      const auto p = weights_in(surface_, found_.crossings, face, segment.end[0]),
                 q = weights_in(surface_, found_.crossings, face, segment.end[1]);
      chords.push_back({Vec2(p[1], p[2]), Vec2(q[1], q[2])});
    }
    return chords;
  }

  const ClosedSurface& closed_;
  const Surface& surface_;
  const Points& x_;
  const Segments& found_;
  DipoleTree tree_;
  std::map<int, std::vector<int>> chords_;  // segments by face
};

// Group numbers of faces: neighbours, and faces that cross, are in one group.
std::vector<int> groups_of(const Surface& surface, const std::vector<WeighedFace>& reached,
                           const std::vector<std::array<int, 2>>& pairs) {
  std::map<int, int> place;
  for (int i = 0; i < static_cast<int>(reached.size()); ++i) place[reached[i].face] = i;
  DisjointSets sets(static_cast<int>(reached.size()));
  const auto join = [&](int a, int b) {
    const auto i = place.find(a), j = place.find(b);
    if (i != place.end() && j != place.end()) sets.join(i->second, j->second);
  };
  for (const auto& [a, b] : pairs) join(a, b);
  for (const WeighedFace& face : reached)
    for (int k = 0; k < 3; ++k) {
      const auto [a, b] = surface.edge_triangles[surface.triangle_edges(face.face, k)];
      if (b >= 0) join(a, b);
    }
  return sets.numbers();
}

struct PushSum {
  double area = 0, value = 0, all = 0;
  Vec3 middle = Vec3::Zero(), net = Vec3::Zero();
};

// Adds the pushes of the faces to the gradient, and values and counts to the report.
void sum_up(const Surface& surface, const Points& x, const std::vector<signed char>& turn,
            const std::vector<WeighedFace>& reached, const std::vector<int>& group, double weight, Points* gradient,
            WindingReport& report, PushSum& total) {
  std::vector<PushSum> sums(group.empty() ? 0 : static_cast<std::size_t>(std::ranges::max(group)) + 1);
  for (const bool last : {false, true})
    for (std::size_t i = 0; i < reached.size(); ++i) {
      const WeighedFace& face = reached[i];
      PushSum& sum = sums[group[i]];
      const auto corner = [&](int k) { return row(x, surface.triangles(face.face, k)); };
      const Vec3 normal = turn[face.face] * (corner(1) - corner(0)).cross(corner(2) - corner(0));
      std::array<double, 3> moment{};
      for (std::size_t c = 0; c < face.cells.size(); ++c)
        for (int k = 0; k < 3; ++k) moment[k] += face.weights[c] * face.cells[c].moment[k];
      const double covered = moment[0] + moment[1] + moment[2], area = normal.norm() * std::abs(covered);
      const Vec3 from = corner(0);
      if (!last) {
        sum.area += area;
        sum.middle += area * (from + corner(1) + corner(2)) / 3;
        continue;
      }
      if (area == 0) continue;
      ++report.faces;
      sum.value += weight / 3 * covered * normal.dot(from - sum.middle / sum.area);
      total.net += covered * normal;
      total.all += area;
      for (int k = 0; k < 3 && gradient; ++k)
        gradient->row(surface.triangles(face.face, k)) += (weight * moment[k]) * normal.transpose();
    }
  for (const PushSum& sum : sums) report.value += sum.value;
}

}  // namespace

double winding_cost(double w) {
  const double t = std::abs(w - 0.5);
  return t <= 1 ? 0 : t <= 1.5 ? 2 * (t - 1) : t - 0.5;
}

WindingReport winding_loss(const ClosedSurface& closed, const Points& x, const Segments& found,
                           const WindingOptions& options, Points* gradient) {
  const Surface& surface = closed.surface;
  if (gradient) *gradient = Points::Zero(surface.vertex_count, 3);
  std::map<int, std::vector<int>> segments;  // of each garment with itself, fans left out
  for (int s = 0; s < static_cast<int>(found.segments.size()); ++s) {
    const auto [a, b] = found.segments[s].triangle;
    if (!closed.is_fan(a) && !closed.is_fan(b) && closed.garment[a] == closed.garment[b])
      segments[closed.garment[a]].push_back(s);
  }
  WindingReport report;
  if (segments.empty()) return report;
  const std::vector<signed char> turn = outward_turns(closed, x);
  PushSum total;
  for (const auto& [garment, own] : segments) {
    std::vector<int> faces;
    for (int t = 0; t < closed.cloth_triangles; ++t)
      if (closed.garment[t] == garment) faces.push_back(t);
    std::vector<std::array<int, 2>> pairs;
    for (const int s : own) pairs.push_back(found.segments[s].triangle);
    GarmentWinding winding(closed, x, found, turn, faces, options.far);
    const std::vector<WeighedFace> reached = winding.reach(pairs, own);
    sum_up(surface, x, turn, reached, groups_of(surface, reached, pairs), options.weight, gradient, report, total);
  }
  report.rim_share = total.all > 0 ? total.net.norm() / total.all : 0;
  return report;
}

}  // namespace selvedge
