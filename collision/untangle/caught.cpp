#include "collision/untangle/caught.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "collision/contour/buried.hpp"
#include "collision/exact/inside.hpp"
#include "collision/geometry/closed_shells.hpp"
#include "collision/geometry/corners.hpp"
#include "collision/search/nearest_face.hpp"
#include "collision/untangle/facing.hpp"

namespace selvedge {
namespace {

constexpr double rigid_tolerance = 1e-3;  // of a mean edge: largest distance of a vertex from a rigid motion

// Sets 1 for vertices of triangles that cross or are buried, and of triangles next to these.
void add_crossing(const Surface& surface, const Points& x, std::vector<char>& marked) {
  const std::vector<SheetView> view{{&surface, &x}};
  const Segments found = find_segments(view);
  if (found.segments.empty()) return;
  const std::vector<char> crossed = buried_vertices(surface, x, found);
  for (const auto& corners : surface.triangles.rowwise())
    if (crossed[corners[0]] || crossed[corners[1]] || crossed[corners[2]])
      for (const int v : corners) marked[v] = 1;
}

Vec3 normal_of(const std::array<Vec3, 3>& at) { return (at[1] - at[0]).cross(at[2] - at[0]).normalized(); }

// The frame of a triangle: along its first edge, perpendicular to it in the plane, and the normal.
Mat3 frame_of(const std::array<Vec3, 3>& at) {
  const Vec3 along = (at[1] - at[0]).normalized(), normal = normal_of(at);
  Mat3 frame;
  frame << along, normal.cross(along), normal;
  return frame;
}

// An obstacle at the start and the end of a step, a part of which may be switched off.
class Closing {
 public:
  // `part`: 1 for each triangle that may be switched off.
  Closing(const Surface& surface, const Points& x0, const Points& x1, std::vector<char> part, double reach)
      : surface_(surface),
        x0_(x0),
        x1_(x1),
        part_(std::move(part)),
        reach_(reach),
        start_(make_face_tree(surface, x0, all_faces(surface))),
        end_(make_face_tree(surface, x1, all_faces(surface))) {}

  double reach() const { return reach_; }
  bool is_near_part(const Vec3& p, double within) const {
    return nearest_face(start_, p, within, [this](int t) { return part_[t] != 0; }).face >= 0;
  }

  // A face through which the body's motion would take p, and where p would end.
  struct Passage {
    int face;
    Vec3 to;
  };
  // p moves with the nearest face that it is in front of, or with the nearest one above it that faces that one: of two
  // parts that close on p either may be the one that moves.
  std::vector<Passage> passages(const Vec3& p) const {
    std::vector<Passage> found;
    const NearestFace own = nearest_face(start_, p, reach_, [this, &p](int t) { return side(x0_, t, p) > 0; });
    if (own.face < 0) return found;
    add_passage(own, p, found);
    const Vec3 normal = normal_of(corners_of(surface_, x0_, own.face));
    const NearestFace opposite = nearest_face(start_, p, reach_, [&](int t) {
      return side(x0_, t, p) > 0 && normal_of(corners_of(surface_, x0_, t)).dot(normal) < facing_cosine;
    });
    if (opposite.face >= 0 && is_above(opposite, p)) add_passage(opposite, p, found);
    return found;
  }

 private:
  static std::vector<int> all_faces(const Surface& surface) {
    std::vector<int> faces(static_cast<std::size_t>(surface.triangles.rows()));
    std::iota(faces.begin(), faces.end(), 0);
    return faces;
  }

  void add_passage(const NearestFace& by, const Vec3& p, std::vector<Passage>& found) const {
    const Vec3 to = carried(by, p), normal = normal_of(corners_of(surface_, x1_, by.face));
    const auto gone_through = [&](int t) {
      return (part_[t] || part_[by.face]) && side(x0_, t, p) > 0 && side(x1_, t, to) < 0 &&
             normal_of(corners_of(surface_, x1_, t)).dot(normal) < facing_cosine;
    };
    const NearestFace other = nearest_face(end_, to, reach_, gone_through);
    if (other.face >= 0) found.push_back({other.face, to});
  }

  // Does p lie in front of the face at the start, and not beside it?
  bool is_above(const NearestFace& by, const Vec3& p) const {
    constexpr double least_cosine = 0.7;  // of 45 degrees
    const std::array<Vec3, 3> at = corners_of(surface_, x0_, by.face);
    const Vec3 off = p - by.weight[0] * at[0] - by.weight[1] * at[1] - by.weight[2] * at[2];
    return normal_of(at).dot(off) > least_cosine * off.norm();
  }

  double side(const Points& x, int t, const Vec3& p) const {
    const std::array<Vec3, 3> at = corners_of(surface_, x, t);
    return normal_of(at).dot(p - at[0]);
  }
  // Where p ends if it moves rigidly with the frame of the face.
  Vec3 carried(const NearestFace& by, const Vec3& p) const {
    const std::array<Vec3, 3> before = corners_of(surface_, x0_, by.face), after = corners_of(surface_, x1_, by.face);
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      from += by.weight[k] * before[k];
      to += by.weight[k] * after[k];
    }
    return to + frame_of(after) * (frame_of(before).transpose() * (p - from));
  }

  const Surface& surface_;
  const Points &x0_, &x1_;
  std::vector<char> part_;
  double reach_;  // largest motion of the part in the step, plus a mean edge [m]
  FaceTree start_, end_;
};

// 1 for each triangle whose vertices are all marked.
std::vector<char> marked_faces(const Surface& body, const std::vector<char>& marked) {
  std::vector<char> faces;
  for (const auto& corners : body.triangles.rowwise())
    faces.push_back(marked[corners[0]] && marked[corners[1]] && marked[corners[2]]);
  return faces;
}

// Marks vertices of the cloth, except `tangled` ones, that the motion of the body catches, and dressed ones near the
// part whose skinned targets it takes into the body.
void catch_anew(const Surface& body, const Points& x1, const Closing& closing, const Points& cloth,
                const std::vector<char>& tangled, const std::vector<char>& dressed, const Points& targets,
                std::vector<char>& caught) {
  const std::vector<char> closed = closed_shells(body);
  std::vector<int> into;  // vertices that are caught if their places are in the body
  std::vector<Vec3> places;
  for (int v = 0; v < cloth.rows(); ++v) {
    if (!cloth.row(v).allFinite() || (!tangled.empty() && tangled[v])) continue;
    if (dressed[v] && closing.is_near_part(row(cloth, v), closing.reach())) {
      into.push_back(v);
      places.push_back(row(targets, v));
    }
    for (const Closing::Passage& passage : closing.passages(row(cloth, v))) {
      if (!closed[body.component[body.triangles(passage.face, 0)]]) {
        caught[v] = 1;
        continue;
      }
      into.push_back(v);
      places.push_back(passage.to);
    }
  }
  Points there(static_cast<Eigen::Index>(into.size()), 3);
  for (std::size_t i = 0; i < into.size(); ++i) there.row(static_cast<Eigen::Index>(i)) = places[i].transpose();
  const std::vector<char> in = inside(body, x1, there);
  for (std::size_t i = 0; i < into.size(); ++i)
    if (in[i]) caught[into[i]] = 1;
}

}  // namespace

std::vector<int> may_be_switched_off(const Surface& surface, const Points& x) {
  std::vector<char> marked(static_cast<std::size_t>(surface.vertex_count), 0);
  add_crossing(surface, x, marked);
  const std::vector<char> part = marked_faces(surface, marked);
  std::vector<int> faces;
  for (int t = 0; t < static_cast<int>(part.size()); ++t)
    if (part[t]) faces.push_back(t);
  return faces;
}

bool moves_rigidly(const Surface& surface, const Points& x0, const Points& x1) {
  if (x0 == x1) return true;
  const Eigen::Matrix4d motion = Eigen::umeyama(x0.transpose(), x1.transpose(), false);
  const Points moved =
      (x0 * motion.topLeftCorner<3, 3>().transpose()).rowwise() + motion.topRightCorner<3, 1>().transpose();
  return (moved - x1).rowwise().norm().maxCoeff() <= rigid_tolerance * mean_edge(surface, x0);
}

void switch_off(const ContactWorld& world, int obstacle, const Points& from, const Points& to, const Points& targets,
                Exemption& exemption) {
  const Surface& body = *world.obstacles[obstacle];
  const int first = world.first_node[obstacle];
  const Points x0 = from.middleRows(first, body.vertex_count), x1 = to.middleRows(first, body.vertex_count),
               cloth = from.topRows(world.cloth->vertex_count);
  if (!x0.allFinite() || !x1.allFinite()) return;
  const std::vector<char>& tangled = exemption.body;
  const bool rigid = moves_rigidly(body, x0, x1);
  if (rigid && (tangled.empty() || targets.rows() == 0)) return;
  std::vector<char> marked(static_cast<std::size_t>(body.vertex_count), 0);
  add_crossing(body, x0, marked);
  add_crossing(body, x1, marked);
  std::vector<char> part = marked_faces(body, marked);
  if (std::ranges::find(part, 1) == part.end()) return;
  double motion = 0;
  for (std::size_t v = 0; v < marked.size(); ++v)
    if (marked[v]) motion = std::max(motion, (x1.row(v) - x0.row(v)).norm());
  const double edge = mean_edge(*world.cloth, cloth);
  const Closing closing(body, x0, x1, std::move(part), motion + edge);
  std::vector<char> caught(static_cast<std::size_t>(cloth.rows()), 0), dressed = caught;
  for (Eigen::Index v = 0; v < targets.rows(); ++v) dressed[v] = targets.row(v).allFinite();
  if (!rigid) catch_anew(body, x1, closing, cloth, tangled, dressed, targets, caught);
  for (std::size_t v = 0; v < tangled.size(); ++v)
    if (tangled[v] && dressed[v]) caught[v] = closing.is_near_part(row(cloth, static_cast<int>(v)), edge);
  if (std::ranges::find(caught, 1) == caught.end()) return;
  if (exemption.switched_off.empty()) exemption.switched_off.assign(static_cast<std::size_t>(world.node_count), 0);
  for (std::size_t v = 0; v < caught.size(); ++v)
    if (caught[v]) exemption.switched_off[v] = 1;
  for (int v = 0; v < body.vertex_count; ++v)
    if (marked[v]) exemption.switched_off[first + v] = 1;
}

std::vector<int> switched_off_counts(const ContactWorld& world, const Exemption& exemption) {
  std::vector<int> count(world.obstacles.size(), 0);
  for (std::size_t k = 0; k < count.size() && !exemption.switched_off.empty(); ++k)
    for (const auto& corners : world.obstacles[k]->triangles.rowwise())
      count[k] +=
          std::ranges::all_of(corners, [&](int v) { return exemption.switched_off[world.first_node[k] + v] != 0; });
  return count;
}

}  // namespace selvedge
