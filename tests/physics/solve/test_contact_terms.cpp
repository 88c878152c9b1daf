#include <catch2/catch.hpp>

#include "physics/solve/contact_terms.hpp"

namespace selvedge::test_contact_terms {

namespace {

// One vertex over a prescribed triangle in y = 0.
struct VertexOnFloor {
  Scene scene;
  Surface cloth = make_surface(1, Triangles(0, 3));
  Surface floor;
  ContactWorld world;
  Eigen::VectorXd inverse_mass = Eigen::VectorXd::Zero(4);
  VertexOnFloor() {
    Triangles t(1, 3);
    t << 0, 1, 2;
    floor = make_surface(3, t);
    world = make_contact_world(cloth, {&floor}, false);
    inverse_mass[0] = 1e4;
  }
  Points nodes(double height) const {
    Points x(4, 3);
    x << 0, height, 0, -1, 0, -1, 0, 0, 2, 1, 0, -1;
    return x;
  }
  std::vector<ContactTerm> terms(double gap, double rest_gap, double h) const {
    const Proximity p{{PairKind::vertex_face, {0, 1, 2, 3}}, {1, -0.375, -0.25, -0.375}, Vec3::UnitY(), gap, rest_gap};
    return contact_terms({scene, world, inverse_mass, nodes(gap), nodes(gap), h}, std::vector{p}).terms;
  }
};

}  // namespace

TEST_CASE("contact terms: gap and target of a vertex over an obstacle", "[contact_terms]") {
  const VertexOnFloor c;
  const auto terms = c.terms(1e-3, 2e-3, 0.01);
  REQUIRE(terms.size() == 1);
  CHECK(contact_gap(terms[0], c.nodes(1.5e-3)) == Approx(1.5e-3));
  CHECK(terms[0].target == Approx(1.1e-3));  // a tenth of the overlap a step
  CHECK(contact_force(terms[0], 1.2e-3).energy == 0);
  CHECK(contact_force(terms[0], 0.9e-3).first < 0);
}

TEST_CASE("contact terms: short steps part what overlaps no faster than longer ones", "[contact_terms]") {
  const VertexOnFloor c;
  const auto speed = [&](double h) { return (c.terms(1e-3, 2e-3, h)[0].target - 1e-3) / h; };
  CHECK(speed(1e-3) == Approx(0.1));  // of the overlap in a millisecond
  CHECK(speed(1e-4) == Approx(0.1));
  CHECK(speed(1e-6) == Approx(0.1));
  CHECK(c.terms(1e-3, 2e-3, 1e-4)[0].sink == Approx(1e-5));  // a load sinks as much as is lifted at half the gap
}

TEST_CASE("contact terms: a moving obstacle carries the gap and the slip with it", "[contact_terms]") {
  const VertexOnFloor c;
  const Proximity p{{PairKind::vertex_face, {0, 1, 2, 3}}, {1, -0.375, -0.25, -0.375}, Vec3::UnitY(), 1e-3, 2e-3};
  Points end = c.nodes(1e-3);
  end.bottomRows(3).rowwise() += Eigen::RowVector3d(0.02, 5e-4, 0);
  const auto terms = contact_terms({c.scene, c.world, c.inverse_mass, c.nodes(1e-3), end, 0.01}, std::vector{p}).terms;
  CHECK(contact_gap(terms[0], c.nodes(1e-3)) == Approx(5e-4));
  const Vec3 slip = contact_slip(terms[0], c.nodes(1e-3), c.nodes(1e-3));
  CHECK(slip.x() == Approx(-0.02));
  CHECK(slip.y() == Approx(0).margin(1e-15));
}

TEST_CASE("contact terms: a pair in which what is free has hardly a part is left out", "[contact_terms]") {
  VertexOnFloor c;
  Separation push;
  push.vertex = {0, 1, 2, 3, -1};
  push.count = 4;
  push.direction = Vec3::UnitY();
  for (const auto& [weight, is_there] : {std::pair(1e-21, false), std::pair(0.005, false), std::pair(0.2, true)}) {
    INFO(weight);
    push.weight = {-weight, 1, weight - 1, 0, 0};
    CHECK((push_compliance(push, c.inverse_mass) > 0) == is_there);
    CHECK(push_terms(std::vector{push}, c.inverse_mass, 1e-3, 0.01).empty() != is_there);
    const Proximity p{
        {PairKind::vertex_face, {0, 1, 2, 3}}, {weight, -0.5 * weight, -0.5 * weight, 0}, Vec3::UnitY(), 1e-3, 2e-3};
    const auto terms =
        contact_terms({c.scene, c.world, c.inverse_mass, c.nodes(1e-3), c.nodes(1e-3), 0.01}, std::vector{p});
    CHECK(terms.terms.empty() != is_there);
  }
}

TEST_CASE("contact terms: a pair that cannot move is left out", "[contact_terms]") {
  VertexOnFloor c;
  c.inverse_mass.setZero();
  CHECK(c.terms(1e-3, 2e-3, 0.01).empty());
}

TEST_CASE("contact terms: what friction allows beyond the solve stops the slip, and no more", "[contact_terms]") {
  const VertexOnFloor c;
  const double h = 0.01, slip_width = 1e-5;
  for (const double slip : {0.5e-5, 1e-2}) {
    auto terms = c.terms(1e-3, 2e-3, h);
    const Points x0 = c.nodes(1e-3);
    Points x = c.nodes(1e-3);
    x(0, 0) += slip;
    terms[0].normal_force = 0.01;
    const double mass = 1e-4, allowed = terms[0].friction * 0.01 * h * h / mass;
    apply_static_friction(terms, c.inverse_mass, x0, h, slip_width, x);
    if (slip < slip_width)
      CHECK(x(0, 0) == Approx(0).margin(1e-12));
    else
      CHECK(x(0, 0) == Approx(slip).epsilon(1e-6));  // sliding: the solve has used the whole bound
    CHECK(allowed > 0.5e-5);
  }
}

TEST_CASE("contact terms: a load is borne without sinking more than allowed", "[contact_terms]") {
  const VertexOnFloor c;
  auto terms = c.terms(1e-3, 2e-3, 0.01);
  const double unloaded = terms[0].stiffness;
  Points forces = Points::Zero(1, 3);
  forces(0, 1) = 5;
  set_load_stiffness(terms, c.inverse_mass, forces);
  CHECK(terms[0].stiffness == unloaded);  // pulled away
  forces(0, 1) = -5;
  set_load_stiffness(terms, c.inverse_mass, forces);
  CHECK(terms[0].stiffness == Approx(5 / terms[0].sink));
  CHECK(-contact_force(terms[0], terms[0].target - terms[0].sink).first == Approx(5).epsilon(0.25));  // less the onset
}

TEST_CASE("contact terms: a load is shared as it is, whatever bears it", "[contact_terms]") {
  // An edge of two vertices on a bar; then a vertex under three terms.
  const Eigen::VectorXd inverse_mass = Eigen::VectorXd::Constant(2, 1e4);
  Points forces(2, 3);
  forces << 0, -3, 0, 0, -3, 0;
  ContactTerm edge;
  edge.nodes = {0, 1, -1, -1};
  edge.weights = {0.5, 0.5, 0, 0};
  edge.sink = 1e-4;
  std::vector<ContactTerm> terms{edge};
  set_load_stiffness(terms, inverse_mass, forces);
  CHECK(terms[0].normal_force == Approx(6));

  ContactTerm vertex;
  vertex.nodes = {0, -1, -1, -1};
  vertex.weights = {1, 0, 0, 0};
  vertex.sink = 1e-4;
  terms.assign(3, vertex);
  set_load_stiffness(terms, inverse_mass, forces);
  for (const ContactTerm& term : terms) CHECK(term.normal_force == Approx(1));
}

TEST_CASE("contact terms: friction is mistaken where its bound was", "[contact_terms]") {
  const double width = 1e-3;
  ContactTerm term;
  term.nodes = {0, -1, -1, -1};
  term.weights = {1, 0, 0, 0};
  term.friction = 0.5;
  term.normal_force = 2;
  ContactTerm more = term, less = term;
  more.normal_force = 4;
  less.normal_force = 1;
  const std::vector solved{term}, higher{more}, lower{less};
  const Points from = Points::Zero(1, 3);
  Points to = from;
  to(0, 0) = 10 * width;  // slides: too much and too little are both wrong
  CHECK(mistaken_friction(solved, solved, from, to, width) == 0);
  CHECK(mistaken_friction(solved, higher, from, to, width) == Approx(0.5));
  CHECK(mistaken_friction(solved, lower, from, to, width) == Approx(1));
  to(0, 0) = 0.1 * width;  // sticks with a fifth of what it may take
  CHECK(mistaken_friction(solved, higher, from, to, width) == 0);
  CHECK(mistaken_friction(solved, lower, from, to, width) == 0);
  to(0, 0) = 0.9 * width;
  CHECK(mistaken_friction(solved, lower, from, to, width) > 0.9);
  CHECK(mean_touching(solved, to) == Approx(0.9 * width));
  CHECK(mean_touching({}, to) == 0);
}

TEST_CASE("contact terms: one that was pressed too deep is stiffened, and not beyond reason", "[contact_terms]") {
  const VertexOnFloor c;
  auto terms = c.terms(1e-3, 2e-3, 0.01);
  const double before = terms[0].stiffness;
  raise_stiffness(terms, c.nodes(1.09e-3));
  CHECK(terms[0].stiffness == before);
  const double deep = terms[0].target - 4 * terms[0].sink - 0.5 * terms[0].softness;
  raise_stiffness(terms, c.nodes(deep));
  CHECK(terms[0].stiffness == Approx(4 * before));
  raise_stiffness(terms, c.nodes(-1e3));
  CHECK(terms[0].stiffness == Approx(1e4 * before));
}

TEST_CASE("contact terms: they follow a pair to where its step ends, unless it has changed sides", "[contact_terms]") {
  const VertexOnFloor c;
  const Proximity p{{PairKind::vertex_face, {0, 1, 2, 3}}, {1, -0.375, -0.25, -0.375}, Vec3::UnitY(), 1e-3, 2e-3};
  auto contacts = contact_terms({c.scene, c.world, c.inverse_mass, c.nodes(1e-3), c.nodes(1e-3), 0.01}, std::vector{p});
  Points end = c.nodes(1.5e-3);
  end(0, 0) = 0.2;
  end.bottomRows(3).rowwise() += Eigen::RowVector3d(0, 2e-4, 0);
  contacts.terms[0].stiffness = 77;
  relinearise({c.scene, c.world, c.inverse_mass, c.nodes(1e-3), end, 0.01}, contacts);
  CHECK(contact_gap(contacts.terms[0], end) == Approx(1.3e-3));
  CHECK(contacts.terms[0].stiffness == 77);
  CHECK(contact_slip(contacts.terms[0], c.nodes(1e-3), end).x() == Approx(0.2));
  const double offset = contacts.terms[0].offset;
  end(0, 1) = -1e-3;
  relinearise({c.scene, c.world, c.inverse_mass, c.nodes(1e-3), end, 0.01}, contacts);
  CHECK(contacts.terms[0].offset == offset);
}

TEST_CASE("contact terms: an impact makes a term; a deep one of a pair that has a term makes it anew",
          "[contact_terms]") {
  const VertexOnFloor c;
  const Points start = c.nodes(3e-3);
  Impact impact{{PairKind::vertex_face, {0, 1, 2, 3}}, {1, -0.375, -0.25, -0.375}, Vec3::UnitY()};
  impact.target = 4e-4;
  Contacts contacts;
  add_impact_terms({c.scene, c.world, c.inverse_mass, start, c.nodes(0), 0.01}, std::vector{impact}, 1e-3, contacts);
  REQUIRE(contacts.terms.size() == 1);
  CHECK(contacts.terms[0].target == Approx(0.5 * c.scene.contact.thickness));
  impact.normal = Vec3(0.6, 0.8, 0);
  add_impact_terms({c.scene, c.world, c.inverse_mass, start, c.nodes(0), 0.01}, std::vector{impact}, 1e-3, contacts);
  CHECK(contacts.terms[0].normal == Vec3::UnitY());  // 0.4 mm deep
  contacts.terms[0].stiffness = 1e6;
  add_impact_terms({c.scene, c.world, c.inverse_mass, start, c.nodes(-1e-3), 0.01}, std::vector{impact}, 1e-3,
                   contacts);
  REQUIRE(contacts.terms.size() == 1);
  CHECK(contacts.terms[0].normal == impact.normal);
  CHECK(contacts.terms[0].stiffness == 1e6);
}

}  // namespace selvedge::test_contact_terms
