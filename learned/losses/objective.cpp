#include "learned/losses/objective.hpp"

#include <cmath>
#include <functional>

#include "collision/geometry/error.hpp"
#include "learned/losses/body_losses.hpp"
#include "learned/losses/cloth_losses.hpp"
#include "learned/losses/volume_loss.hpp"

namespace selvedge {
namespace {

void check_rows(const Points* points, int rows, const char* what) {
  if (!points || points->rows() != rows)
    throw Error(std::string(what) + " have not a row for each vertex", "inputs of the losses", "");
}

void check_inputs(const LossInputs& in) {
  if (!in.garment) throw Error("there is no garment", "inputs of the losses", "");
  const int vertices = in.garment->surface.vertex_count;
  check_rows(in.x, vertices, "positions");
  check_rows(in.velocity, vertices, "velocities");
  check_rows(in.predicted, vertices, "predicted positions");
  if (in.acceleration) check_rows(in.acceleration, vertices, "accelerations");
  if (!in.body) return;
  check_rows(in.body_previous, in.body->vertex_count, "the body's previous positions");
  check_rows(in.body_now, in.body->vertex_count, "the body's positions");
  check_rows(in.body_next, in.body->vertex_count, "the body's next positions");
  if (in.body_left_out && !in.body_left_out->empty() &&
      in.body_left_out->size() != static_cast<std::size_t>(in.body->triangles.rows()))
    throw Error("what is left out of the body is not a flag for each face", "inputs of the losses", "");
}

// The weight at this progress of the run.
double weight_now(const LossRamp& ramp, const LossInputs& in) { return weight_at(ramp, in.progress); }

bool has_body(const LossInputs& in) { return in.body && in.body->triangles.rows() > 0; }

const std::vector<char>& left_out_of(const LossInputs& in) {
  static const std::vector<char> none;
  return in.body_left_out ? *in.body_left_out : none;
}

double dt_of(const LossInputs& in, const LossOptions& options) {
  return in.is_initial ? options.relaxation_dt : in.timestep;
}

// The value of a loss without its weight; adds the derivative.
using Loss = std::function<double(Points*)>;

double norm_of_free(const LossGarment& garment, const Points& gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < gradient.rows(); ++v)
    if (!garment.pinned[static_cast<std::size_t>(v)]) sum += gradient.row(v).squaredNorm();
  return std::sqrt(sum);
}

LossTerm add_term(const char* name, double weight, const Loss& loss, const LossGarment& garment, Points* gradient) {
  LossTerm term{name, weight, 0, 0};
  if (!gradient) {
    term.value = weight * loss(nullptr);
    return term;
  }
  Points own = Points::Zero(gradient->rows(), 3);
  term.value = weight * loss(&own);
  own *= weight;
  term.gradient_norm = norm_of_free(garment, own);
  if (std::isfinite(term.value) && own.allFinite()) *gradient += own;
  return term;
}

double contour_loss(const LossInputs& in, const ContourLoss& options, const Segments& crossings, Points* gradient) {
  const SheetView sheet{&in.garment->surface, in.predicted};
  std::vector<Points> by_sheet;
  const double value = contour_energy({&sheet, 1}, crossings, ContourMeasure::squared_length,
                                      gradient ? &by_sheet : nullptr, options.gradient, options.normal);
  if (gradient) *gradient += by_sheet[0];
  return value;
}

bool looks_for_contours(const LossInputs& in, const LossOptions& options) {
  return in.contours && weight_now(options.contours.weight, in) != 0;
}

// What depends on the prediction.
void find_of_prediction(const LossInputs& in, const LossOptions& options, LossSearch& search) {
  if (has_body(in) && weight_now(options.friction.weight, in) != 0)
    search.matches.friction_after =
        nearest_centroids(*in.body, *in.body_now, left_out_of(in), *in.predicted, search.after);
  search.matches.crossings = {};
  const bool has_faces = in.garment->surface.triangles.rows() > 0;
  if (!has_faces || !looks_for_contours(in, options) || !in.predicted->allFinite()) return;
  const SheetView sheet = refreshed_sheet(in.garment->surface, *in.predicted, search.cloth);
  search.matches.crossings = find_segments({&sheet, 1});
}

void find_of_state(const LossInputs& in, const LossOptions& options, LossSearch& search) {
  if (!has_body(in)) return;
  const CollisionLoss& collision = options.collision;
  if (weight_now(collision.weight, in) != 0) {
    const Points points = sample_points(cloth_samples(*in.garment, collision.samples), *in.x);
    search.matches.collision_face =
        collision.matching == BodyMatching::nearest_centroid
            ? nearest_centroids(*in.body, *in.body_now, left_out_of(in), points, search.collision)
            : nearest_faces(*in.body, *in.body_now, left_out_of(in), collision.radius, points, search.collision);
  }
  if (weight_now(options.friction.weight, in) != 0)
    search.matches.friction_before =
        nearest_centroids(*in.body, *in.body_previous, left_out_of(in), *in.x, search.before);
}

std::vector<LossTerm> add_checked(const LossInputs& in, const LossOptions& options, const LossMatches& matches,
                                  Points* gradient) {
  const LossGarment& garment = *in.garment;
  const Points& x = *in.predicted;
  std::vector<LossTerm> terms;
  const auto add = [&](const char* name, const LossRamp& ramp, const Loss& loss) {
    if (const double weight = weight_now(ramp, in); weight != 0)
      terms.push_back(add_term(name, weight, loss, garment, gradient));
  };
  add("stretching", options.stretching,
      [&](Points* g) { return stretching_loss(garment, x, g) + spring_loss(garment, x, g); });
  add("bending", options.bending, [&](Points* g) { return bending_loss(garment, x, g); });
  if (in.acceleration)
    add("forces", options.gravity, [&](Points* g) { return force_loss(garment.mass, *in.acceleration, x, g); });
  else
    add("gravity", options.gravity, [&](Points* g) { return gravity_loss(garment, options.gravity_strength, x, g); });
  add("inertia", options.inertia,
      [&](Points* g) { return inertia_loss(garment, *in.x, *in.velocity, dt_of(in, options), x, g); });
  if (has_body(in)) {
    add("collision", options.collision.weight, [&](Points* g) {
      return collision_loss(garment, options.collision, matches.collision_face, *in.body, *in.body_next, x, g);
    });
    add("friction", options.friction.weight, [&](Points* g) {
      return friction_loss(garment, options.friction, options.gravity_strength, matches.friction_before,
                           matches.friction_after, *in.body, *in.body_previous, *in.body_now, *in.x, x, g);
    });
  }
  add("repulsion", options.repulsion.weight,
      [&](Points* g) { return repulsion_loss(garment, options.repulsion, in.repulsion, *in.x, x, g); });
  add("volume", options.volume.weight, [&](Points* g) { return volume_loss(garment.closed, options.volume, x, g); });
  add("vertex_repulsion", options.vertex_repulsion.weight, [&](Points* g) {
    return vertex_repulsion_loss(garment.surface, options.vertex_repulsion.distance, options.vertex_repulsion.power, x,
                                 g);
  });
  if (in.contours)
    add("contours", options.contours.weight,
        [&](Points* g) { return contour_loss(in, options.contours, matches.crossings, g); });
  return terms;
}

void check_match(const std::vector<int>& faces, const LossInputs& in, const LossRamp& ramp,
                 ClothSamples samples = ClothSamples::vertices) {
  if (!has_body(in) || weight_now(ramp, in) == 0) return;
  if (faces.size() != cloth_samples(*in.garment, samples).size())
    throw Error("there is not a face of the body, or none, for each vertex or other sample", "matches of the losses",
                "");
}

}  // namespace

LossInputs loss_inputs(const LossGarment& garment, const GraphScene& scene, const GraphState& state,
                       const SeenPositions& seen, const Points& predicted) {
  LossInputs in;
  in.garment = &garment;
  in.x = &seen.x;
  in.velocity = &state.velocity;
  in.predicted = &predicted;
  if (state.body.rows() > 0) {
    in.body = &scene.body;
    in.body_previous = &state.body_previous;
    in.body_now = &state.body;
    in.body_next = &state.body_target;
  }
  in.is_initial = state.is_init;
  in.timestep = state.timestep;
  return in;
}

void find_matches(const LossInputs& in, const LossOptions& options, LossSearch& search) {
  check_inputs(in);
  find_of_state(in, options, search);
  find_of_prediction(in, options, search);
}

std::vector<LossTerm> add_losses(const LossInputs& in, const LossOptions& options, const LossMatches& matches,
                                 Points* gradient) {
  check_inputs(in);
  if (gradient) check_rows(gradient, in.garment->surface.vertex_count, "gradients");
  check_match(matches.collision_face, in, options.collision.weight, options.collision.samples);
  check_match(matches.friction_before, in, options.friction.weight);
  check_match(matches.friction_after, in, options.friction.weight);
  return add_checked(in, options, matches, gradient);
}

std::vector<LossTerm> add_losses(const LossInputs& in, const LossOptions& options, LossSearch& search,
                                 Points* gradient) {
  find_matches(in, options, search);
  return add_losses(in, options, search.matches, gradient);
}

double sum_of(std::span<const LossTerm> terms) {
  double sum = 0;
  for (const LossTerm& term : terms) sum += term.value;
  return sum;
}

std::vector<double> losses_along(const LossInputs& inputs, const LossOptions& options, const Points& base,
                                 std::span<const double> t, LossSearch& search) {
  check_inputs(inputs);
  check_rows(&base, inputs.garment->surface.vertex_count, "positions of the base");
  find_of_state(inputs, options, search);
  LossInputs in = inputs;
  Points x;
  in.predicted = &x;
  std::vector<double> sums;
  for (const double at : t) {
    x = base + at * (*inputs.predicted - base);
    find_of_prediction(in, options, search);
    sums.push_back(sum_of(add_losses(in, options, search.matches, nullptr)));
  }
  return sums;
}

Points points_of(std::span<const float> rows) {
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(rows.data(), static_cast<Eigen::Index>(rows.size() / 3), 3).cast<double>();
}

void add_to(const Points& points, std::span<float> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] += static_cast<float>(points.data()[i]);
}

}  // namespace selvedge
