#include <catch2/catch.hpp>

#include "physics/solve/contour_potential.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_contour_potential {

using testing::make_world;
using testing::World;

namespace {

// A level sheet and a corner of a steep one that goes through it: an open contour.
World pierced_world() {
  testing::Sheet corner = testing::sheet(5, 0.2, 0);
  const Mat3 turn = (Eigen::AngleAxisd(1.3, Vec3::UnitX()) * Eigen::AngleAxisd(0.7, Vec3::UnitY())).toRotationMatrix();
  corner.x = (corner.x * turn.transpose()).eval();
  corner.x.col(1).array() += 0.085;
  corner.x.col(0).array() += 0.011;
  World w = make_world(testing::join(testing::sheet(8, 0.4, 0), corner));
  w.drive.acceleration.setZero();
  return w;
}

struct Phi {
  World w;
  ContactWorld contact;
  ContourPotential contour;
  AddedTerm added;
  ImplicitEuler solver;
  StepProblem problem;

  explicit Phi(const World& world, ContourGradient kind)
      : w(world),
        contact(make_contact_world(w.scene.surface, {}, true)),
        contour(contact, w.state.x, 3, kind),
        added{[this](const Points& x) { return contour.value(x); },
              [this](const Points& x, Points& gradient, std::vector<ContactBlock>& blocks) {
                contour.add_derivatives(x, gradient, blocks);
              }},
        solver(w.scene, {}) {
    problem.h = 1.0 / 60;
    problem.x0 = &w.state.x;
    problem.v0 = &w.state.v;
    problem.pins = &w.drive.pins;
    problem.added = &added;
  }
};

Points direction(Eigen::Index rows) {
  Points d(rows, 3);
  for (Eigen::Index i = 0; i < d.size(); ++i) d.data()[i] = std::sin(1.7 * static_cast<double>(i) + 0.3);
  return d;
}

}  // namespace

TEST_CASE("contour potential: the gradient of Phi is its derivative while the contours stay", "[contour_potential]") {
  Phi phi(pierced_world(), ContourGradient::full);
  const Points x = phi.w.state.x, d = direction(x.rows());
  const auto found = phi.contour.segments(x).segments.size();
  REQUIRE(found > 4);
  const double step = 1e-7;
  const double ahead = phi.solver.potential(phi.problem, x + step * d);
  REQUIRE(phi.contour.segments(x + step * d).segments.size() == found);
  const double behind = phi.solver.potential(phi.problem, x - step * d);
  REQUIRE(phi.contour.segments(x - step * d).segments.size() == found);
  const double slope = phi.solver.gradient(phi.problem, x).cwiseProduct(d).sum();
  CHECK(slope == Approx((ahead - behind) / (2 * step)).epsilon(1e-5));
  phi.problem.added = nullptr;
  const double without = phi.solver.gradient(phi.problem, x).cwiseProduct(d).sum();
  CHECK(std::abs(without - slope) > 0.1 * std::abs(slope));
}

TEST_CASE("contour potential: a force on the cloth alone has no sum", "[contour_potential]") {
  for (const auto kind : {ContourGradient::translational, ContourGradient::full}) {
    Phi phi(pierced_world(), kind);
    Points gradient = Points::Zero(phi.w.state.x.rows(), 3);
    std::vector<ContactBlock> blocks;
    phi.contour.add_derivatives(phi.w.state.x, gradient, blocks);
    CHECK(gradient.norm() > 0);
    CHECK(gradient.colwise().sum().norm() < 1e-12 * gradient.norm());
    CHECK(blocks.size() == 2 * phi.contour.segments(phi.w.state.x).crossings.size());
  }
}

TEST_CASE("contour potential: the blocks bound the Gauss-Newton Hessian", "[contour_potential]") {
  Phi phi(pierced_world(), ContourGradient::translational);
  const Points x = phi.w.state.x;
  const Segments found = phi.contour.segments(x);
  Points zero = Points::Zero(x.rows(), 3);
  std::vector<ContactBlock> blocks;
  phi.contour.add_derivatives(x, zero, blocks);
  for (int trial = 0; trial < 20; ++trial) {
    Points d = Points::Zero(x.rows(), 3);
    for (Eigen::Index i = 0; i < d.size(); ++i) d.data()[i] = std::sin(3.1 * static_cast<double>(i * (trial + 1)));
    double bound = 0;
    for (const ContactBlock& b : blocks) {
      Vec3 motion = Vec3::Zero();
      for (int k = 0; k < 4; ++k)
        if (b.nodes[k] >= 0) motion += b.weights[k] * row(d, b.nodes[k]);
      bound += motion.dot(contact_matrix(b) * motion);
    }
    // Of each segment's end the motion that the translational gradient sees, along the edge.
    const std::vector<SheetView> sheets{{&phi.w.scene.surface, &x}};
    double gauss_newton = 0;
    for (const Segment& segment : found.segments) {
      Vec3 difference = Vec3::Zero();
      for (int end = 0; end < 2; ++end) {
        if (segment.end[end] < 0) continue;
        const Crossing& c = found.crossings[segment.end[end]];
        const Surface& s = phi.w.scene.surface;
        const Vec3 along = row(x, s.edges(c.edge, 1)) - row(x, s.edges(c.edge, 0));
        Vec3 apart = (1 - c.s) * row(d, s.edges(c.edge, 0)) + c.s * row(d, s.edges(c.edge, 1));
        for (int k = 0; k < 3; ++k) apart -= c.weight[k] * row(d, s.triangles(c.face, k));
        const Vec3 d0 = row(x, s.triangles(c.face, 0));
        const Vec3 normal = (row(x, s.triangles(c.face, 1)) - d0).cross(row(x, s.triangles(c.face, 2)) - d0);
        difference += (end == 0 ? 1 : -1) * -normal.dot(apart) / normal.dot(along) * along;
      }
      gauss_newton += 2 * 3 * difference.squaredNorm();
    }
    CHECK(gauss_newton <= bound);
    CHECK(gauss_newton > 0);
  }
}

}  // namespace selvedge::test_contour_potential
