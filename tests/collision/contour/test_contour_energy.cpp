#include <catch2/catch.hpp>

#include <random>

#include "collision/contour/contour_energy.hpp"
#include "tests/collision/sheets.hpp"

namespace selvedge::test_contour_energy {

namespace {

// Two crossing sheets and a pinch with a loop vertex, in one surface.
struct Tangle {
  testing::Sheet mesh;
  Surface surface;
  Points wall_x;
  Surface wall;
  Segments found;

  Tangle() {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-0.04, 0.04);
    testing::Sheet a = testing::sheet(6, 2, 0), b = testing::sheet(5, 2, 0), pinch = testing::sheet(7, 2, 0);
    for (int v = 0; v < b.x.rows(); ++v) {
      const Vec3 p = row(b.x, v);
      b.x.row(v) << 0.3 * p.z(), p.x() + 0.2, p.z() + 0.5;
    }
    for (int v = 0; v < pinch.x.rows(); ++v) {
      const double u = pinch.x(v, 0), w = pinch.x(v, 2) - 0.3;
      pinch.x.row(v) << 5 + u * w, u, w * w;
    }
    mesh = testing::join(testing::join(a, b), pinch);
    for (double& value : mesh.x.reshaped()) value += noise(random);
    surface = make_surface(static_cast<int>(mesh.x.rows()), mesh.triangles);
    testing::Sheet c = testing::sheet(3, 1.5, 0);
    for (int v = 0; v < c.x.rows(); ++v) {
      const Vec3 p = row(c.x, v);
      c.x.row(v) << 0.6 + 0.1 * p.x(), p.x(), p.z() - 0.3;
    }
    wall_x = c.x;
    wall = make_surface(static_cast<int>(c.x.rows()), c.triangles);
    found = find_segments(sheets());
  }
  std::vector<SheetView> sheets() const { return {{&surface, &mesh.x}, {&wall, &wall_x}}; }
};

struct Frozen {
  Vec3 a, b, normal;
  std::array<double, 3> weight;
};

// The definition itself, with or without frozen ends, normals and weights.
double surrogate(const Tangle& tangle, const std::vector<SheetView>& sheets, const std::vector<Frozen>* frozen,
                 std::vector<Frozen>* store, ContourMeasure measure, double normal_sign = 1) {
  double value = 0;
  std::size_t next = 0;
  for (const Segment& segment : tangle.found.segments) {
    std::array<Vec3, 2> at;
    for (int end = 0; end < 2; ++end) {
      if (segment.end[end] < 0) {
        at[end] = row(*sheets[0].x, ~segment.end[end]);
        if (frozen) at[end] = (*frozen)[next].a;
        if (store) store->push_back({at[end], at[end], Vec3::Zero(), {}});
        ++next;
        continue;
      }
      const Crossing& c = tangle.found.crossings[segment.end[end]];
      const Surface &se = *sheets[c.edge_sheet].surface, &sf = *sheets[c.face_sheet].surface;
      const Vec3 a = row(*sheets[c.edge_sheet].x, se.edges(c.edge, 0));
      const Vec3 b = row(*sheets[c.edge_sheet].x, se.edges(c.edge, 1));
      std::array<Vec3, 3> d;
      for (int k = 0; k < 3; ++k) d[k] = row(*sheets[c.face_sheet].x, sf.triangles(c.face, k));
      const Frozen now{a, b, normal_sign * (d[1] - d[0]).cross(d[2] - d[0]).normalized(), c.weight};
      const Frozen& use = frozen ? (*frozen)[next] : now;
      const Vec3 on_face = use.weight[0] * d[0] + use.weight[1] * d[1] + use.weight[2] * d[2];
      const double s = (use.normal.dot(on_face) - use.normal.dot(a)) / use.normal.dot(b - a);
      at[end] = use.a + s * (use.b - use.a);
      if (store) store->push_back(now);
      ++next;
    }
    const double square = (at[0] - at[1]).squaredNorm();
    value += measure == ContourMeasure::squared_length ? square : std::sqrt(square);
  }
  return value;
}

template <class Value>
void check_differences(Tangle& tangle, const std::vector<Points>& gradient, Value value) {
  const double step = 1e-6;
  double scale = 0;
  for (const Points& g : gradient) scale = std::max(scale, g.cwiseAbs().maxCoeff());
  REQUIRE(scale > 0.1);
  for (int sheet = 0; sheet < 2; ++sheet) {
    Points& x = sheet == 0 ? tangle.mesh.x : tangle.wall_x;
    for (int v = 0; v < x.rows(); ++v)
      for (int k = 0; k < 3; ++k) {
        const double at = x(v, k);
        x(v, k) = at + step;
        const double up = value();
        x(v, k) = at - step;
        const double down = value();
        x(v, k) = at;
        REQUIRE(std::abs((up - down) / (2 * step) - gradient[sheet](v, k)) < 1e-6 * (1 + scale));
      }
  }
}

}  // namespace

TEST_CASE("contour energy: value and full gradient, the normal differentiated", "[contour_energy]") {
  Tangle tangle;
  int at_vertex = 0;
  for (const Segment& segment : tangle.found.segments) at_vertex += segment.at_vertex();
  REQUIRE(tangle.found.segments.size() > 40);
  REQUIRE(at_vertex > 0);
  for (ContourMeasure measure : {ContourMeasure::squared_length, ContourMeasure::length}) {
    std::vector<Points> gradient;
    const double value = contour_energy(tangle.sheets(), tangle.found, measure, &gradient, ContourGradient::full);
    CHECK(value == Approx(surrogate(tangle, tangle.sheets(), nullptr, nullptr, measure)));
    check_differences(tangle, gradient, [&] { return contour_energy(tangle.sheets(), tangle.found, measure); });
  }
}

TEST_CASE("contour energy: the translational gradient is that with ends and normals frozen", "[contour_energy]") {
  Tangle tangle;
  for (ContourMeasure measure : {ContourMeasure::squared_length, ContourMeasure::length}) {
    std::vector<Frozen> frozen;
    surrogate(tangle, tangle.sheets(), nullptr, &frozen, measure);
    std::vector<Points> gradient;
    contour_energy(tangle.sheets(), tangle.found, measure, &gradient, ContourGradient::translational);
    check_differences(tangle, gradient, [&] { return surrogate(tangle, tangle.sheets(), &frozen, nullptr, measure); });
  }
}

TEST_CASE("contour energy: with frozen normals faces move their crossings through their centroids",
          "[contour_energy]") {
  Tangle tangle;
  const ContourMeasure measure = ContourMeasure::squared_length;
  std::vector<Frozen> frozen;
  surrogate(tangle, tangle.sheets(), nullptr, &frozen, measure);
  for (Frozen& end : frozen) end.weight.fill(1.0 / 3);
  std::vector<Points> gradient, turning, full, full_turning;
  const auto energy = [&](ContourGradient kind, ContourNormal normal, std::vector<Points>& of) {
    return contour_energy(tangle.sheets(), tangle.found, measure, &of, kind, normal);
  };
  CHECK(energy(ContourGradient::translational, ContourNormal::frozen, gradient) ==
        energy(ContourGradient::translational, ContourNormal::turning, turning));
  check_differences(tangle, gradient, [&] { return surrogate(tangle, tangle.sheets(), &frozen, nullptr, measure); });
  CHECK((gradient[0] - turning[0]).norm() > 0.01 * turning[0].norm());
  // What the full gradient adds, distortion, does not know of normals.
  energy(ContourGradient::full, ContourNormal::frozen, full);
  energy(ContourGradient::full, ContourNormal::turning, full_turning);
  for (int sheet = 0; sheet < 2; ++sheet)
    CHECK(((full[sheet] - gradient[sheet]) - (full_turning[sheet] - turning[sheet])).norm() < 1e-12);
}

TEST_CASE("contour energy: turning the normals over changes nothing", "[contour_energy]") {
  Tangle tangle;
  std::vector<Points> gradient, turned_gradient;
  const double value = contour_energy(tangle.sheets(), tangle.found, ContourMeasure::squared_length, &gradient);
  Tangle turned = tangle;
  Triangles triangles = tangle.surface.triangles;
  triangles.col(1).swap(triangles.col(2));
  turned.surface = make_surface(tangle.surface.vertex_count, triangles);
  turned.found = find_segments(turned.sheets());
  CHECK(contour_energy(turned.sheets(), turned.found, ContourMeasure::squared_length, &turned_gradient) ==
        Approx(value));
  for (int sheet = 0; sheet < 2; ++sheet)
    CHECK((gradient[sheet] - turned_gradient[sheet]).cwiseAbs().maxCoeff() < 1e-11);
  CHECK(surrogate(tangle, tangle.sheets(), nullptr, nullptr, ContourMeasure::squared_length, -1) == Approx(value));
}

TEST_CASE("contour energy: forces of one pair balance", "[contour_energy]") {
  Tangle tangle;
  for (ContourGradient kind : {ContourGradient::translational, ContourGradient::full})
    for (const Segment& segment : tangle.found.segments) {
      Segments one = tangle.found;
      one.segments = {segment};
      std::vector<Points> gradient;
      contour_energy(tangle.sheets(), one, ContourMeasure::squared_length, &gradient, kind);
      const Vec3 sum = (gradient[0].colwise().sum() + gradient[1].colwise().sum()).transpose();
      REQUIRE(sum.norm() < 1e-12 * (1 + gradient[0].cwiseAbs().maxCoeff()));
    }
}

TEST_CASE("contour energy: translation alone moves along the faces' normals", "[contour_energy]") {
  // A triangle through a level one: the translational part of its pull is vertical (figure 3 of the paper).
  const Triangles triangles = (Triangles(2, 3) << 0, 1, 2, 3, 4, 5).finished();
  const Points x =
      (Points(6, 3) << -3, 0, -3, 3, 0, -3, 0, 0, 3, -0.5, 0.4, 0.1, 0.6, 0.5, 0, 0.1, -0.6, 0.05).finished();
  const Surface surface = make_surface(6, triangles);
  const std::array sheets{SheetView{&surface, &x}};
  const Segments found = find_segments(sheets);
  REQUIRE(found.segments.size() == 1);
  std::vector<Points> gradient;
  contour_energy(sheets, found, ContourMeasure::squared_length, &gradient);
  for (int v = 0; v < 6; ++v) {
    CHECK(std::abs(gradient[0](v, 0)) < 1e-12);
    CHECK(std::abs(gradient[0](v, 2)) < 1e-12);
  }
  CHECK(gradient[0](5, 1) < 0);  // going down lengthens the segment: minus the gradient pulls the tip out
  CHECK(gradient[0](3, 1) < 0);
  contour_energy(sheets, found, ContourMeasure::squared_length, &gradient, ContourGradient::full);
  CHECK(gradient[0].col(0).cwiseAbs().maxCoeff() > 0.1);
}

}  // namespace selvedge::test_contour_energy
