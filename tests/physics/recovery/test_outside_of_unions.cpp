#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "collision/exact/outward_faces.hpp"
#include "collision/geometry/same_places.hpp"
#include "collision/geometry/welded_surface.hpp"
#include "physics/scene/make_scene.hpp"
#include "physics/steppers/decorated_stepper.hpp"
#include "tests/frame.hpp"
#include "tests/physics/worlds.hpp"

namespace selvedge::test_outside_of_unions {

using testing::add_obstacle;
using testing::join;
using testing::make_world;
using testing::Sheet;
using testing::sheet;
using testing::World;

namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0; }
  int index(int count) { return static_cast<int>(engine_() % static_cast<unsigned>(count)); }
  bool one_in(int count) { return index(count) == 0; }
  Mat3 turn() {
    const Vec3 axis = Vec3(number(-1, 1), number(-1, 1), number(0.1, 1)).normalized();
    return Eigen::AngleAxisd(number(0, std::numbers::pi), axis).toRotationMatrix();
  }

 private:
  std::mt19937 engine_;
};

// A closed shell and what it is: all that is nearer than `radius` to a segment along its y axis (a sphere where the
// segment has no length), or a box.
struct Shell {
  Sheet mesh;
  Vec3 half = Vec3::Zero();  // of the box
  double radius = 0, half_length = 0;
  Mat3 turn = Mat3::Identity();
  Vec3 centre = Vec3::Zero();

  // Deeper in the solid than its mesh of chords is anywhere from it.
  bool holds(const Vec3& p) const {
    const Vec3 at = turn.transpose() * (p - centre);
    if (radius == 0) return (half - at.cwiseAbs()).minCoeff() > 1e-9;
    const Vec3 axis(0, std::clamp(at.y(), -half_length, half_length), 0);
    return (at - axis).norm() < radius * chord;
  }
  static constexpr double chord = 0.93;  // 12 round and 6 from pole to pole: cos(15 degrees) twice, at the least
};

// Patches of a grid each, at first with vertices of their own.
void add_patch(int rows, int columns, const std::function<Vec3(double, double)>& at, Sheet& mesh) {
  Sheet patch;
  patch.x.resize((rows + 1) * (columns + 1), 3);
  patch.triangles.resize(2 * rows * columns, 3);
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j)
      patch.x.row(i * (columns + 1) + j) = at(double(i) / rows, double(j) / columns).transpose();
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const int a = i * (columns + 1) + j, b = a + 1, c = a + columns + 1, t = 2 * (i * columns + j);
      patch.triangles.row(t) << a, b, c;
      patch.triangles.row(t + 1) << c, b, c + 1;
    }
  mesh = mesh.x.rows() == 0 ? patch : join(mesh, patch);
}

// Joins what lies at one place, and leaves triangles without area out.
Sheet joined(const Sheet& loose) {
  const std::vector<int> places = same_places(loose.x);
  Sheet mesh{loose.x, Triangles(loose.triangles.rows(), 3)};
  int count = 0;
  for (const auto& t : loose.triangles.rowwise())
    if (const Eigen::RowVector3i at(places[t[0]], places[t[1]], places[t[2]]);
        at[0] != at[1] && at[1] != at[2] && at[2] != at[0])
      mesh.triangles.row(count++) = at;
  mesh.triangles.conservativeResize(count, 3);
  return mesh;
}

Shell shell(Dice& dice) {
  Shell s;
  Sheet loose;
  if (dice.one_in(3)) {
    s.half = Vec3(dice.number(0.05, 0.12), dice.number(0.05, 0.12), dice.number(0.05, 0.12));
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0})
        add_patch(
            3, 3,
            [&](double u, double v) {
              Vec3 p;
              p[axis] = side * s.half[axis];
              p[(axis + 1) % 3] = side * (2 * v - 1) * s.half[(axis + 1) % 3];
              p[(axis + 2) % 3] = (2 * u - 1) * s.half[(axis + 2) % 3];
              return Vec3(p);
            },
            loose);
  } else {
    s.radius = dice.number(0.05, 0.1);
    s.half_length = dice.one_in(2) ? 0 : dice.number(0.03, 0.1);
    add_patch(
        7, 12,
        [&](double u, double v) {
          const double ring = std::round(7 * u),
                       up = ring <= 3 ? ring - 3 : ring - 4;  // the middle band is the capsule's cylinder
          const double tilt = up * std::numbers::pi / 6, round = 2 * std::numbers::pi * v;
          return Vec3(s.radius * std::cos(tilt) * std::cos(round),
                      s.radius * std::sin(tilt) + (ring <= 3.5 ? -1 : 1) * s.half_length,
                      -s.radius * std::cos(tilt) * std::sin(round));
        },
        loose);
  }
  s.mesh = joined(loose);
  s.turn = dice.turn();
  return s;
}

// Gives the faces on one side of a plane vertices of their own: a seam all round.
void split(const Vec3& normal, Sheet& mesh) {
  const Eigen::Index n = mesh.x.rows();
  Points x(2 * n, 3);
  x << mesh.x, mesh.x;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const auto corners = mesh.triangles.row(t);
    if (normal.dot(row(mesh.x, corners[0]) + row(mesh.x, corners[1]) + row(mesh.x, corners[2])) > 0)
      mesh.triangles.row(t).array() += static_cast<int>(n);
  }
  mesh.x = x;
}

// All faces inside out, as a file may have a mirrored part.
void flip(Sheet& mesh) {
  const Triangles as_given = mesh.triangles;
  mesh.triangles.col(1) = as_given.col(2);
  mesh.triangles.col(2) = as_given.col(1);
}

// A patch of faces again, with vertices of its own.
void copy_patch(Dice& dice, Sheet& mesh) {
  Sheet patch{mesh.x, mesh.triangles.middleRows(dice.index(20), 12)};
  mesh = join(mesh, patch);
}

enum class Moves { still, together, under };

struct Union {
  std::vector<Shell> shells;
  Moves moves = Moves::still;
  Vec3 speed = Vec3::Zero();   // [m/s]
  double spin = 0;             // about the vertical [rad/s]
  Vec3 rising = Vec3::Zero();  // of the last shell, below the others [m/s]

  // Of shell k at a time.
  Shell at(std::size_t k, double time) const {
    Shell s = shells[k];
    if (moves == Moves::under && k + 1 == shells.size()) s.centre += time * rising;
    if (moves == Moves::together) {
      const Mat3 turned = Eigen::AngleAxisd(spin * time, Vec3::UnitY()).toRotationMatrix();
      s.turn = turned * s.turn;
      s.centre = turned * s.centre + time * speed;
    }
    return s;
  }
  Points points(double time) const {
    Points all(0, 3);
    for (std::size_t k = 0; k < shells.size(); ++k) {
      const Shell s = at(k, time);
      Points joined(all.rows() + s.mesh.x.rows(), 3);
      joined << all, (s.mesh.x * s.turn.transpose()).rowwise() + s.centre.transpose();
      all = joined;
    }
    return all;
  }
  bool holds(const Vec3& p, double time) const {
    for (std::size_t k = 0; k < shells.size(); ++k)
      if (at(k, time).holds(p)) return true;
    return false;
  }
};

Union random_union(unsigned seed) {
  Dice dice(seed);
  Union u;
  const int count = 2 + dice.index(5);
  for (int k = 0; k < count; ++k) {
    Shell s = shell(dice);
    if (k > 0) {
      const double within = 0.1;  // less than two shells are wide: it overlaps the first one, or another
      s.centre = u.shells[static_cast<std::size_t>(dice.index(k))].centre +
                 within * Vec3(dice.number(-1, 1), dice.number(-0.5, 0.5), dice.number(-1, 1));
    }
    if (dice.one_in(2)) split(Vec3(dice.number(-1, 1), dice.number(-1, 1), dice.number(-1, 1)), s.mesh);
    if (dice.one_in(3)) copy_patch(dice, s.mesh);
    u.shells.push_back(s);
  }
  if (!dice.one_in(3)) flip(u.shells[static_cast<std::size_t>(dice.index(count))].mesh);
  u.moves = static_cast<Moves>(dice.index(3));
  u.speed = Vec3(dice.number(-0.3, 0.3), dice.number(-0.1, 0.3), dice.number(-0.3, 0.3));
  u.spin = dice.number(-2, 2);
  if (u.moves == Moves::under) {  // the last one comes up from below into the first one, whose top it stays under
    Shell &first = u.shells.front(), &last = u.shells.back();
    first.turn.setIdentity();
    const auto reach = [](const Shell& s) { return s.radius > 0 ? s.radius + s.half_length : s.half.norm(); };
    last.centre = first.centre - Vec3(0, reach(first) + reach(last), 0);
    u.rising = Vec3(0, 0.05, 0);
  }
  return u;
}

// What of a sheet that falls on the union is wrong, in all frames.
struct Found {
  int inside = 0, pairs = 0, rejected = 0, moving_frames = 0;
};

// The surface as reading makes an obstacle of it: closed shells face outwards, and seams are welded.
struct Read {
  Surface surface;
  std::vector<int> together;  // vertices that are held together, as welded_surface has them
};

Read as_read(const Union& u, double dt, int frames) {
  Sheet body = u.shells.front().mesh;
  for (std::size_t k = 1; k < u.shells.size(); ++k) body = join(body, u.shells[k].mesh);
  std::vector<Points> sequence;
  for (int frame = 0; frame <= frames; ++frame) sequence.push_back(u.points(frame * dt));
  const std::vector<int> places = same_places(sequence);
  const OutwardFaces outward = face_outward(body.triangles, sequence, places);
  Read read{make_surface(static_cast<int>(body.x.rows()), outward.triangles), {}};
  if (std::optional<WeldedSurface> welded = welded_surface(read.surface, places))
    read = {std::move(welded->surface), std::move(welded->joined)};
  return read;
}

Found drop_on(const Union& u) {
  const double dt = 1.0 / 30;
  const int frames = 16;
  const Points at_start = u.points(0);
  World w = make_world(sheet(11, 0.5, at_start.col(1).maxCoeff() + 0.02));
  const Read body = as_read(u, dt, frames);
  add_obstacle(w, {at_start, body.surface.triangles});
  w.scene.obstacles[0].surface = body.surface;
  w.scene.obstacles[0].moving = u.moves != Moves::still;
  const auto stepper = make_recovering_conventional_stepper(w.scene, {});
  State state = w.state;
  Drive drive = w.drive;
  const auto place = [&](double time) {
    Points x = u.points(time);
    hold_together(body.together, x);
    return x;
  };
  state.obstacles[0] = place(0);
  Found found;
  for (int frame = 1; frame <= frames; ++frame) {
    drive.obstacles = {place(frame * dt)};
    State to;
    const StepReport report = testing::frame(w.scene, *stepper, state, drive, dt, to);
    if (report.status != StepStatus::accepted) {
      ++found.rejected;
      break;
    }
    found.pairs += report.collision.pairs_after;
    for (int v = 0; v < to.x.rows(); ++v) found.inside += u.holds(row(to.x, v), frame * dt);
    state = to;
  }
  return found;
}

void check_unions(unsigned first, unsigned count) {
  for (unsigned seed = first; seed < first + count; ++seed) {
    const Found found = drop_on(random_union(seed));
    CAPTURE(seed);
    CHECK(found.inside == 0);
    CHECK(found.pairs == 0);
    CHECK(found.rejected == 0);
  }
}

}  // namespace

TEST_CASE("the outside of a union of closed shells is closed: 20 random ones", "[unions]") { check_unions(1, 20); }

TEST_CASE("the outside of a union of closed shells is closed: 180 more", "[unions][.long]") { check_unions(21, 180); }

}  // namespace selvedge::test_outside_of_unions
