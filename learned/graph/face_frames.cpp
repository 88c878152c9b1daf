#include "learned/graph/face_frames.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {
namespace {

// Products of u and w with a vector in the plane of e and f are its coordinates along e and f.
struct DualFrame {
  Vec3 u, w, n;
  bool flat = true;  // e and f span no plane
};

DualFrame dual_frame(const Vec3& e, const Vec3& f) {
  const Vec3 cross = e.cross(f);
  const double squared = cross.squaredNorm();
  if (!(squared > 0) || !std::isfinite(1 / squared)) return {};
  return {f.cross(cross) / squared, cross.cross(e) / squared, cross / std::sqrt(squared), false};
}

void set_lane(Bvh::Lanes (&lanes)[3][2], int place, const Vec3& value) {
  for (int k = 0; k < 3; ++k) lanes[k][place / 4][place % 4] = static_cast<float>(value[k]);
}

Bvh::Lanes product(const Bvh::Lanes (&a)[3][2], const Bvh::Lanes (&b)[3], int half) {
  return a[0][half] * b[0] + a[1][half] * b[1] + a[2][half] * b[2];
}

// A weight is a sum of three products. Rounding to float enters each coordinate twice.
float slack_of(const DualFrame& frame, double reach) {
  const double steepest = std::max(frame.u.cwiseAbs().sum(), frame.w.cwiseAbs().sum());
  return static_cast<float>(1e-6 + 1e-6 * steepest * reach);
}

}  // namespace

void prism_boxes(const Surface& surface, const Points& x, double radius, const Box& around, std::vector<Box>& boxes) {
  const int count = static_cast<int>(surface.triangles.rows());
  boxes.resize(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(static)
  for (int face = 0; face < count; ++face) {
    const int* v = surface.triangles.data() + 3 * face;
    const Vec3 a = row(x, v[0]), b = row(x, v[1]), c = row(x, v[2]);
    const Vec3 least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    Box& box = boxes[static_cast<std::size_t>(face)];
    box = empty_box;
    if (!overlap(moving_point_box(least, most, 1.001 * radius), around)) continue;
    const Vec3 cross = (b - a).cross(c - a);
    const double length = cross.norm();
    if (!(length > 0)) continue;
    for (int k = 0; k < 3; ++k) {
      const double grown = radius * (1e-6 + std::abs(cross[k]) / length * (1 + 1e-6));
      box.lo[static_cast<std::size_t>(k)] = round_down(least[k] - grown);
      box.hi[static_cast<std::size_t>(k)] = round_up(most[k] + grown);
    }
  }
}

void make_frames(const Surface& surface, const Points& x, const Bvh& tree, std::vector<FrameLeaf>& frames) {
  const int count = static_cast<int>(tree.leaves.size());
  frames.resize(tree.leaves.size());
#pragma omp parallel for schedule(static)
  for (int leaf = 0; leaf < count; ++leaf)
    for (int place = 0; place < Bvh::leaf_size; ++place) {
      FrameLeaf& frame = frames[static_cast<std::size_t>(leaf)];
      const Bvh::Leaf& boxes = tree.leaves[static_cast<std::size_t>(leaf)];
      const bool used = boxes.item[place] >= 0 && !is_empty(box_of(boxes, place));
      const int face = used ? boxes.item[place] : -1;
      if (face < 0) {
        frame.slack[place / 4][place % 4] = -1;
        continue;
      }
      const int* v = surface.triangles.data() + 3 * face;
      const Vec3 a = row(x, v[0]);
      const DualFrame dual = dual_frame(row(x, v[1]) - a, row(x, v[2]) - a);
      const Vec3 zero = Vec3::Zero();
      set_lane(frame.origin, place, a);
      set_lane(frame.u, place, dual.flat ? zero : dual.u);
      set_lane(frame.w, place, dual.flat ? zero : dual.w);
      set_lane(frame.n, place, dual.flat ? zero : dual.n);
      const float slack = dual.flat ? -1.0f : slack_of(dual, a.cwiseAbs().maxCoeff() + 1);  // below 0: none projects
      frame.slack[place / 4][place % 4] = slack;
    }
}

unsigned may_project(const FrameLeaf& frame, const Vec3& p, float radius) {
  LaneFlags flags[2];
  for (int half = 0; half < 2; ++half) {
    Bvh::Lanes d[3];
    for (int k = 0; k < 3; ++k) d[k] = static_cast<float>(p[k]) - frame.origin[k][half];
    const Bvh::Lanes u = product(frame.u, d, half), w = product(frame.w, d, half), n = product(frame.n, d, half);
    const Bvh::Lanes slack = frame.slack[half], wide = radius * 1.001f + 1e-5f + 0 * slack;
    flags[half] = (slack >= 0) & (u >= -slack) & (w >= -slack) & (u + w <= 1 + 2 * slack) & (n <= wide) & (n >= -wide);
  }
  return bits_of(flags[0], flags[1]);
}

Foot foot_on(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const DualFrame dual = dual_frame(b - a, c - a);
  if (dual.flat) return {};
  const Vec3 d = p - a;
  const double u = dual.u.dot(d), w = dual.w.dot(d);
  return {u >= 0 && w >= 0 && u + w <= 1, dual.n.dot(d)};
}

}  // namespace selvedge
