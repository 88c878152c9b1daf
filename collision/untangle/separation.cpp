#include "collision/untangle/separation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "collision/contour/contour_translation.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/closed_shells.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/search/nearest_face.hpp"

namespace selvedge {
namespace {

// Collects the terms of a separation; those of obstacles go to the right-hand side.
struct Maker {
  std::span<const SheetView> sheets;
  Separation made;
  double value = 0;  // of the left-hand side at present

  Maker(std::span<const SheetView> all, const Vec3& direction) : sheets(all) { made.direction = direction; }
  void add(int sheet, int vertex, double weight) {
    const double part = weight * made.direction.dot(row(*sheets[sheet].x, vertex));
    value += part;
    if (sheet != 0) {
      made.least -= part;
      return;
    }
    made.vertex[made.count] = vertex;
    made.weight[made.count++] = weight;
  }
  void add_face(int sheet, int face, const std::array<double, 3>& weight, double sign) {
    for (int k = 0; k < 3; ++k) add(sheet, sheets[sheet].surface->triangles(face, k), sign * weight[k]);
  }
  Separation at_least(double least) {
    Separation result = made;
    result.least += least;
    return result;
  }
};

struct Setting {
  std::span<const SheetView> sheets;
  const Segments& found;
  std::span<const Contour> contours;
  SeparationLengths lengths;
  std::vector<std::vector<char>> closed;     // components of the obstacles: 1 if closed
  std::vector<std::vector<char>> wrong;      // of each region: 1 at its vertices
  std::map<std::array<int, 4>, int> region;  // by sheet, component and partner
  std::vector<Points> normals;               // of the vertices of each sheet

  Vec3 face_normal(int sheet, int face) const {
    return twice_area(sheets[sheet].surface->triangles, *sheets[sheet].x, face).normalized();
  }
  Vec3 at(int sheet, int face, const std::array<double, 3>& w) const {
    return weighted_corners(*sheets[sheet].surface, *sheets[sheet].x, face, w);
  }
  Vec3 smooth_normal(int sheet, int face, const std::array<double, 3>& w) const {
    return weighted_corners(*sheets[sheet].surface, normals[sheet], face, w).normalized();
  }
  int region_of(const Contour& contour, int side) const {
    const ContourSide &own = contour.sides[side], &other = contour.sides[1 - side];
    return region.at({own.sheet, own.component, other.sheet, other.component});
  }
};

// A connected set of vertices on the wrong side, with the contours that bound it.
struct Patch {
  int region = 0;
  std::vector<int> vertices;
  std::map<std::pair<int, int>, int> bounds;  // contour and side -> votes for the right side of the partner
};

// Numbers of the patches by region and vertex, -1 elsewhere.
using PatchOf = std::vector<std::vector<int>>;

std::vector<Patch> find_patches(const Setting& setting, std::span<const Region> regions, PatchOf& patch_of) {
  std::vector<Patch> patches;
  patch_of.clear();
  for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
    const Surface& surface = *setting.sheets[regions[r].sheet].surface;
    patch_of.emplace_back(surface.vertex_count, -1);
    for (int seed : regions[r].vertices) {
      if (patch_of[r][seed] >= 0) continue;
      const int number = static_cast<int>(patches.size());
      Patch patch{r, {seed}, {}};
      patch_of[r][seed] = number;
      for (std::size_t i = 0; i < patch.vertices.size(); ++i)
        for (int t : surface.triangles_of(patch.vertices[i]))
          for (int k = 0; k < 3; ++k) {
            const int v = surface.triangles(t, k);
            if (!setting.wrong[r][v] || patch_of[r][v] >= 0) continue;
            patch_of[r][v] = number;
            patch.vertices.push_back(v);
          }
      patches.push_back(std::move(patch));
    }
  }
  return patches;
}

Vec3 normal_at(const Setting& setting, const Crossing& c) { return setting.face_normal(c.face_sheet, c.face); }

// For a crossing whose edge has one end on the wrong side: moves that end to the side of the other.
Separation pull_back(const Setting& setting, const Crossing& c, int wrong, int right) {
  const Vec3 normal = normal_at(setting, c);
  const Vec3 from_face = row(*setting.sheets[c.edge_sheet].x, right) - setting.at(c.face_sheet, c.face, c.weight);
  Maker maker(setting.sheets, normal.dot(from_face) < 0 ? Vec3(-normal) : normal);
  maker.add(c.edge_sheet, wrong, 1);
  maker.add_face(c.face_sheet, c.face, c.weight, -1);
  return maker.at_least(std::min(setting.lengths.gap, maker.value + setting.lengths.step));
}

Separation move_apart(const Setting& setting, const Crossing& c, const Vec3& direction, double step) {
  const Surface& surface = *setting.sheets[c.edge_sheet].surface;
  Maker maker(setting.sheets, direction);
  maker.add(c.edge_sheet, surface.edges(c.edge, 0), 1 - c.s);
  maker.add(c.edge_sheet, surface.edges(c.edge, 1), c.s);
  maker.add_face(c.face_sheet, c.face, c.weight, -1);
  return maker.at_least(maker.value + step);
}

// Outward normal of a closed obstacle where it meets the cloth.
Vec3 outward(const Setting& setting, const Crossing& c) {
  if (c.face_sheet != 0) return setting.smooth_normal(c.face_sheet, c.face, c.weight);
  const Surface& surface = *setting.sheets[c.edge_sheet].surface;
  const Points& normals = setting.normals[c.edge_sheet];
  return ((1 - c.s) * row(normals, surface.edges(c.edge, 0)) + c.s * row(normals, surface.edges(c.edge, 1)))
      .normalized();
}

bool meets_closed_obstacle(const Setting& setting, const Contour& contour) {
  const ContourSide& other = contour.sides[contour.sides[0].sheet == 0 ? 1 : 0];
  return other.sheet != 0 && setting.closed[other.sheet][other.component];
}

bool against_closed_obstacle(const Setting& setting, const Region& region) {
  return region.partner_sheet != 0 && setting.closed[region.partner_sheet][region.partner_component];
}

void part_crossings(const Setting& setting, int number, const PatchOf& patch_of, std::vector<Patch>& patches,
                    std::vector<Separation>& separations) {
  const Contour& contour = setting.contours[number];
  const ContourTranslation translation = contour_translation(setting.sheets, setting.found, contour);
  // Not std::clamp: a shortened step may be below the gap.
  const double step = std::min(std::max(0.25 * contour.length, setting.lengths.gap), setting.lengths.step);
  const bool body = meets_closed_obstacle(setting, contour);
  for (std::size_t i = 0; i < contour.points.size(); ++i) {
    if (contour.points[i] < 0) continue;
    const Crossing& c = setting.found.crossings[contour.points[i]];
    const int side = contour.point_side[i], region = setting.region_of(contour, side);
    const Surface& surface = *setting.sheets[c.edge_sheet].surface;
    const int p = surface.edges(c.edge, 0), q = surface.edges(c.edge, 1);
    const bool wrong_p = setting.wrong[region][p], wrong_q = setting.wrong[region][q];
    if (wrong_p != wrong_q && !(body && c.edge_sheet != 0)) {
      const int wrong = wrong_p ? p : q, right = wrong_p ? q : p;
      separations.push_back(pull_back(setting, c, wrong, right));
      const Vec3 from_face = row(*setting.sheets[c.edge_sheet].x, right) - setting.at(c.face_sheet, c.face, c.weight);
      const int vote = normal_at(setting, c).dot(from_face) > 0 ? 1 : -1;
      patches[patch_of[region][wrong]].bounds[{number, side}] += vote;
      continue;
    }
    Vec3 direction = translation.mean.norm() > 0.3 ? translation.mean : translation.local[i];
    if (side == 1) direction = -direction;
    if (body) direction = c.edge_sheet == 0 ? outward(setting, c) : Vec3(-outward(setting, c));
    const double length = direction.norm();
    if (length > 0 && std::isfinite(length)) separations.push_back(move_apart(setting, c, direction / length, step));
  }
}

// Faces of the partner that the vertices of a patch went through, or may be behind, and the side to which they must go.
struct Target {
  int sheet = 0;
  std::vector<int> faces;
  double sign = 0;  // side relative to the faces' normals; 0: not known
};

Target target_of(const Setting& setting, const Patch& patch, std::span<const Region> regions,
                 const std::vector<Patch>& patches) {
  Target target{regions[patch.region].partner_sheet, {}, 0};
  const Surface& surface = *setting.sheets[target.sheet].surface;
  int votes = 0;
  std::vector<char> partner(surface.vertex_count, 0);
  for (const auto& [bound, count] : patch.bounds) {
    // A patch on both sides of a contour is a fold; its partner is the patch itself.
    if (patch.bounds.count({bound.first, 1 - bound.second})) return target;
    votes += count;
    const std::vector<int>& path = setting.contours[bound.first].sides[1 - bound.second].triangles;
    target.faces.insert(target.faces.end(), path.begin(), path.end());
    for (const Patch& other : patches)
      if (&other != &patch && other.bounds.count({bound.first, 1 - bound.second}))
        for (int v : other.vertices) partner[v] = 1;
  }
  for (int v = 0; v < surface.vertex_count; ++v)
    if (partner[v])
      target.faces.insert(target.faces.end(), surface.triangles_of(v).begin(), surface.triangles_of(v).end());
  sort_once(target.faces);
  target.sign = votes;
  return target;
}

// Adds a demand that moves a vertex toward the right side of its nearest point on the faces; none without a face.
void push_through(const Setting& setting, int vertex, int sheet, const NearestFace& nearest, double sign,
                  std::vector<Separation>& separations) {
  if (nearest.face < 0) return;
  const Vec3 normal = sign * setting.smooth_normal(sheet, nearest.face, nearest.weight);
  if (!normal.allFinite()) return;
  Maker maker(setting.sheets, normal);
  maker.add(0, vertex, 1);
  maker.add_face(sheet, nearest.face, nearest.weight, -1);
  separations.push_back(maker.at_least(std::min(setting.lengths.gap, maker.value + setting.lengths.step)));
}

void push_patch(const Setting& setting, const Patch& patch, std::span<const Region> regions,
                const std::vector<Patch>& patches, std::vector<Separation>& separations) {
  const Region& region = regions[patch.region];
  const Target target = target_of(setting, patch, regions, patches);
  if (target.sign == 0 || target.faces.empty()) return;
  const double sign = target.sign > 0 ? 1 : -1;
  const SheetView& sheet = setting.sheets[target.sheet];
  const FaceTree faces = make_face_tree(*sheet.surface, *sheet.x, target.faces);
  for (int v : patch.vertices) {
    const int own = region.sheet == target.sheet ? v : -1;
    const NearestFace nearest = nearest_face(faces, own, row(*setting.sheets[region.sheet].x, v));
    push_through(setting, v, target.sheet, nearest, sign, separations);
  }
}

// Vertices of the cloth inside a closed obstacle.
std::vector<char> inside_obstacle(std::span<const SheetView> sheets, int obstacle) {
  const Surface& surface = *sheets[obstacle].surface;
  return inside(surface, *sheets[obstacle].x, *sheets[0].x);
}

void push_out(const Setting& setting, std::span<const std::vector<char>> buried, std::vector<Separation>& separations) {
  for (int k = 1; k < static_cast<int>(setting.sheets.size()); ++k) {
    const std::vector<char> in = inside_obstacle(setting.sheets, k);
    if (std::find(in.begin(), in.end(), 1) == in.end()) continue;
    const SheetView& obstacle = setting.sheets[k];
    std::vector<int> all(obstacle.surface->triangles.rows());
    std::iota(all.begin(), all.end(), 0);
    std::erase_if(all, [&](int t) { return !buried.empty() && buried[static_cast<std::size_t>(k) - 1][t]; });
    const FaceTree faces = make_face_tree(*obstacle.surface, *obstacle.x, std::move(all));
    for (int v = 0; v < static_cast<int>(in.size()); ++v)
      if (in[v] && setting.sheets[0].surface->vertex_owner[v] >= 0)
        push_through(setting, v, k, nearest_face(faces, -1, row(*setting.sheets[0].x, v)), 1, separations);
  }
}

Setting make_setting(std::span<const SheetView> sheets, const Segments& found, std::span<const Contour> contours,
                     std::span<const Region> regions, const SeparationLengths& lengths) {
  Setting setting{sheets, found, contours, lengths, {}, {}, {}, {}};
  for (const SheetView& sheet : sheets) {
    setting.closed.push_back(closed_shells(*sheet.surface));
    setting.normals.push_back(vertex_normals(*sheet.surface, *sheet.x));
  }
  for (int r = 0; r < static_cast<int>(regions.size()); ++r) {
    const Region& region = regions[r];
    setting.region[{region.sheet, region.component, region.partner_sheet, region.partner_component}] = r;
    setting.wrong.emplace_back(sheets[region.sheet].surface->vertex_count, 0);
    for (int v : region.vertices) setting.wrong.back()[v] = 1;
  }
  return setting;
}

}  // namespace

void order_layers(std::span<const SheetView> sheets, const Segments& found, std::span<const Contour> contours,
                  const std::vector<int>& layers, std::vector<Region>& regions) {
  const Setting setting = make_setting(sheets, found, contours, regions, {});
  const Surface& cloth = *sheets[0].surface;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    Region& region = regions[r];
    if (region.sheet != 0 || region.partner_sheet != 0 || !region.cut) continue;
    const int order = layers[region.component] - layers[region.partner_component];
    if (order == 0) continue;
    int votes = 0;
    for (int number : region.contours)
      for (std::size_t i = 0; i < contours[number].points.size(); ++i) {
        const int point = contours[number].points[i], side = contours[number].point_side[i];
        if (point < 0 || setting.region_of(contours[number], side) != static_cast<int>(r)) continue;
        const Crossing& c = found.crossings[point];
        const int p = cloth.edges(c.edge, 0), q = cloth.edges(c.edge, 1);
        if (setting.wrong[r][p] == setting.wrong[r][q]) continue;
        const Vec3 from_face =
            row(*sheets[0].x, setting.wrong[r][p] ? q : p) - setting.at(c.face_sheet, c.face, c.weight);
        votes += normal_at(setting, c).dot(from_face) > 0 ? 1 : -1;
      }
    if (votes * order >= 0) continue;
    region.vertices.clear();
    for (int v = 0; v < cloth.vertex_count; ++v)
      if (cloth.component[v] == region.component && !setting.wrong[r][v]) region.vertices.push_back(v);
  }
}

std::vector<Separation> part_contours(std::span<const SheetView> sheets, const Segments& found,
                                      std::span<const Contour> contours, std::span<const Region> regions,
                                      const SeparationLengths& lengths, std::span<const std::vector<char>> buried) {
  const Setting setting = make_setting(sheets, found, contours, regions, lengths);
  PatchOf patch_of;
  std::vector<Patch> patches = find_patches(setting, regions, patch_of);
  std::vector<Separation> separations;
  for (int c = 0; c < static_cast<int>(contours.size()); ++c)
    part_crossings(setting, c, patch_of, patches, separations);
  for (const Patch& patch : patches)
    if (regions[patch.region].sheet == 0 && !against_closed_obstacle(setting, regions[patch.region]))
      push_patch(setting, patch, regions, patches, separations);
  push_out(setting, buried, separations);
  return separations;
}

bool is_against_obstacle(const Separation& separation) {
  double sum = 0;
  for (int i = 0; i < separation.count; ++i) sum += separation.weight[i];
  return std::abs(sum) > 0.5;
}

std::vector<char> inside_obstacles(std::span<const SheetView> sheets) {
  std::vector<char> inside_any(sheets[0].surface->vertex_count, 0);
  for (int k = 1; k < static_cast<int>(sheets.size()); ++k) {
    const std::vector<char> in = inside_obstacle(sheets, k);
    for (std::size_t v = 0; v < in.size(); ++v)
      if (in[v] && sheets[0].surface->vertex_owner[v] >= 0) inside_any[v] = 1;
  }
  return inside_any;
}

}  // namespace selvedge
