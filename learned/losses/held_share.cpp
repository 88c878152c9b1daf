#include "learned/losses/held_share.hpp"

#include <algorithm>
#include <cmath>

namespace selvedge {

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

}  // namespace selvedge
