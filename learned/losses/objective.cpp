#include "learned/losses/objective.hpp"

#include <algorithm>
#include <cmath>

#include "collision/geometry/error.hpp"
#include "learned/losses/body_losses.hpp"

namespace selvedge {
namespace {

void check_rows(const Points* points, int rows, const char* what) {
  if (!points || points->rows() != rows)
    throw Error(std::string(what) + " need one row for each vertex", "inputs of the losses",
                "give arrays of this garment and body");
}

void check_inputs(const LossInputs& in) {
  if (!in.garment) throw Error("there is no garment", "inputs of the losses", "set `garment`");
  const int vertices = in.garment->surface.vertex_count;
  check_rows(in.x, vertices, "positions");
  check_rows(in.velocity, vertices, "velocities");
  check_rows(in.predicted, vertices, "predicted positions");
  if (in.acceleration) check_rows(in.acceleration, vertices, "accelerations");
  if (in.target) check_rows(in.target, vertices, "targets");
  if (!in.body) return;
  check_rows(in.body_previous, in.body->vertex_count, "the body's previous positions");
  check_rows(in.body_now, in.body->vertex_count, "the body's positions");
  check_rows(in.body_next, in.body->vertex_count, "the body's next positions");
  if (in.body_left_out && !in.body_left_out->empty() &&
      in.body_left_out->size() != static_cast<std::size_t>(in.body->triangles.rows()))
    throw Error("faces left out of the body need one flag for each face", "inputs of the losses",
                "give flags of this body, or none");
}

double weight_now(const LossRamp& ramp, const LossInputs& in) { return weight_at(ramp, in.progress); }

const std::vector<char>& left_out_of(const LossInputs& in) {
  static const std::vector<char> none;
  return in.body_left_out ? *in.body_left_out : none;
}

double norm_of_free(const LossGarment& garment, const Points& gradient) {
  double sum = 0;
  for (Eigen::Index v = 0; v < gradient.rows(); ++v)
    if (!garment.pinned[static_cast<std::size_t>(v)]) sum += gradient.row(v).squaredNorm();
  return std::sqrt(sum);
}

LossTerm add_term(const LossRow& row, const LossFrame& frame, double weight, Points* gradient) {
  LossTerm term{&row, row.name, weight, 0, 0};
  if (!gradient) {
    term.value = weight * row.value(frame, nullptr);
    return term;
  }
  Points own = Points::Zero(gradient->rows(), 3);
  term.value = weight * row.value(frame, &own);
  own *= weight;
  term.gradient_norm = norm_of_free(*frame.in.garment, own);
  if (std::isfinite(term.value) && own.allFinite()) *gradient += own;
  return term;
}

bool looks_for_contours(const LossInputs& in, const LossOptions& options) {
  return in.contours && weight_now(options.contours.weight, in) != 0;
}

// Finds the matches that depend on the prediction.
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

void check_match(const std::vector<int>& faces, const LossInputs& in, const LossRamp& ramp,
                 ClothSamples samples = ClothSamples::vertices) {
  if (!has_body(in) || weight_now(ramp, in) == 0) return;
  if (faces.size() != cloth_samples(*in.garment, samples).size())
    throw Error("each sample of the cloth needs a face of the body, or -1", "matches of the losses", "");
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
  const LossFrame frame{in, options, matches};
  std::vector<LossTerm> terms;
  for (const LossRow& row : loss_rows())
    if (const double weight = weight_now(row.weight(options), in);
        weight != 0 && (!row.takes_part || row.takes_part(in)))
      terms.push_back(add_term(row, frame, weight, gradient));
  return terms;
}

std::vector<LossTerm> add_losses(const LossInputs& in, const LossOptions& options, LossSearch& search,
                                 Points* gradient) {
  find_matches(in, options, search);
  return add_losses(in, options, search.matches, gradient);
}

std::vector<LossTerm> add_losses_with_share(const LossInputs& in, const LossOptions& options, LossSearch& search,
                                            Points& gradient) {
  Points all = Points::Zero(gradient.rows(), 3);
  std::vector<LossTerm> terms = add_losses(in, options, search, &all);
  const auto contours = std::ranges::find(terms, "contours", &LossTerm::name);
  if (options.contours.share > 0 && contours != terms.end()) {
    LossOptions without = options;
    without.contours.weight = {0, 0};
    Points others = Points::Zero(gradient.rows(), 3);
    add_losses(in, without, search.matches, &others);
    const Points own = all - others;
    const double wanted = options.contours.share / (1 - options.contours.share);
    const double scale = wanted * inverse_mass_norm(*in.garment, others) / inverse_mass_norm(*in.garment, own);
    if (std::isfinite(scale) && scale > 0) {
      all = others + scale * own;
      for (double* one : {&contours->weight, &contours->value, &contours->gradient_norm}) *one *= scale;
    }
  }
  gradient += all;
  return terms;
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

}  // namespace selvedge
