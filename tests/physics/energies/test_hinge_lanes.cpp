#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>
#include <numbers>
#include <random>

#include "tests/physics/single_elements.hpp"

namespace selvedge::test_hinge_lanes {

using single::hinge_derivatives;
using single::Mat12;
using single::Vec12;

namespace {

// Loose hinges with four vertices each, of every kind; the last ones are degenerate.
struct LooseHinges {
  std::vector<Hinge> hinges;
  Points x;

  explicit LooseHinges(int count) : x(4 * count, 3) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> anywhere(-1, 1);
    for (double& value : x.reshaped()) value = anywhere(random);
    for (int h = 0; h < count; ++h) {
      const double rest = h % 3 == 0 ? 0 : std::numbers::pi * anywhere(random);
      hinges.push_back({{4 * h, 4 * h + 1, 4 * h + 2, 4 * h + 3},
                        0.5 + 0.1 * h,
                        rest,
                        h % 2 ? HingeLength::current : HingeLength::rest});
    }
    x.row(4 * count - 3) = x.row(4 * count - 4);  // no edge
    x.row(4 * count - 6) = x.row(4 * count - 8);  // a tip at the edge's end
    x.middleRows(4 * count - 12, 4).setZero();
    x.middleRows(4 * count - 16, 4) << 0, 0, 0, 1, 0, 0, 0.5, 1e-6, 0, 0.3, 0, 1;  // a sliver
    x.middleRows(4 * count - 20, 4) << 0, 0, 0, 1, 0, 0, 0.5, 1, 0, 0.3, -1, 0;    // flat
  }
};

// The positive eigenvalues, summed, of scale x the second derivative of a dihedral angle, of the part of one wing.
double positive_part(const Points& x, int tip, double scale) {
  const Vec3 edge = row(x, 1) - row(x, 0), up = row(x, tip) - row(x, 0);
  const double length = edge.norm(), foot = up.dot(edge) / edge.squaredNorm(), height = (up - foot * edge).norm();
  const Vec3 r(foot - 1, -foot, 1), q(-1, 1, 0);
  Eigen::Matrix<double, 3, 6> mixed;  // of motion along the normal with motion along the edge, then across it
  mixed.leftCols<3>() = q * r.transpose() / (height * length);
  mixed.rightCols<3>() = r * r.transpose() / (height * height) + q * q.transpose() / (2 * length * length);
  Eigen::Matrix<double, 9, 9> part = Eigen::Matrix<double, 9, 9>::Zero();
  part.topRightCorner<3, 6>() = scale * mixed;
  part.bottomLeftCorner<6, 3>() = part.topRightCorner<3, 6>().transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>>(part).eigenvalues().cwiseMax(0).sum();
}

}  // namespace

TEST_CASE("hinge lanes: the projection adds no more than what makes each wing's part positive", "[bending]") {
  LooseHinges loose(41);
  for (std::size_t h = 0; h < 30; ++h) {
    Hinge hinge = loose.hinges[h];
    hinge.nodes = {0, 1, 2, 3};
    hinge.length = HingeLength::rest;
    const Points x = loose.x.middleRows(4 * static_cast<int>(h), 4);
    Vec12 gradient;
    Mat12 hessian;
    const double energy = hinge_derivatives(hinge, x, gradient, &hessian, true);
    const double scale = std::sqrt(2 * energy * hinge.weight);  // weight x difference; its sign does not matter
    double trace = hinge.weight * gradient.squaredNorm() / (scale * scale);
    for (int tip : {2, 3}) trace += positive_part(x, tip, scale);
    CHECK(hessian.trace() == Approx(trace).epsilon(1e-9));
  }
}

TEST_CASE("hinge lanes: energies, gradients and Hessians are those of single hinges", "[bending]") {
  const LooseHinges loose(77);
  const bool psd = GENERATE(false, true);
  std::span<const Hinge> rest = loose.hinges;
  CHECK(hinge_energy(rest, loose.x) > 0);
  HingeLanes lanes, bare;
  for (; !rest.empty(); rest = rest.subspan(static_cast<std::size_t>(lanes.count))) {
    hinge_energies(rest, loose.x, true, lanes);
    hinge_hessians(psd, lanes);
    hinge_energies(rest, loose.x, false, bare);
    REQUIRE(lanes.count == static_cast<int>(std::min<std::size_t>(rest.size(), HingeLanes::width)));
    for (int l = 0; l < lanes.count; ++l) {
      const Hinge& hinge = rest[static_cast<std::size_t>(l)];
      INFO("hinge " << hinge.nodes[0] / 4);
      Vec12 gradient;
      Mat12 hessian;
      CHECK(lanes.energy[l] == Approx(hinge_energy(hinge, loose.x)).epsilon(1e-12).margin(1e-28));
      CHECK(bare.energy[l] == lanes.energy[l]);
      CHECK(hinge_derivatives(hinge, loose.x, gradient, &hessian, psd) == lanes.energy[l]);
      for (int k = 0; k < 12; ++k) CHECK(lanes.force[k][l] == gradient[k]);
      for (int i = 0, pair = 0; i < 4; ++i)
        for (int j = i + 1; j < 4; ++j, ++pair)
          CHECK(block_of(lanes, pair, l) == Mat3(hessian.block<3, 3>(3 * i, 3 * j)));
    }
  }
}

TEST_CASE("hinge lanes: angles all the way round", "[bending]") {
  std::vector<Hinge> one{{{0, 1, 2, 3}, 2, 0, HingeLength::rest}};
  HingeLanes lanes;
  for (int degrees = -179; degrees <= 180; ++degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    Points x(4, 3);
    x << 0, 0, 0, 1, 0, 0, 0, -std::sin(angle / 2), -std::cos(angle / 2), 0, -std::sin(angle / 2), std::cos(angle / 2);
    hinge_energies(one, x, false, lanes);
    CHECK(std::sqrt(lanes.energy[0]) == Approx(std::abs(angle)).epsilon(1e-14).margin(1e-15));
  }
}

}  // namespace selvedge::test_hinge_lanes
