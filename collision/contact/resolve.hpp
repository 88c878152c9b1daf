#pragma once

#include "collision/contact/path_pairs.hpp"
#include "collision/contact/resolve_options.hpp"
#include "collision/contact/response.hpp"

namespace selvedge {

// Every impact of the straight motion x0 -> x1 with at least one node that has a mass, sorted by pair.
std::vector<Impact> find_impacts(PairSearch&, const Eigen::VectorXd& inverse_mass, const ResolveOptions&,
                                 const Points& x0, const Points& x1, PathPairs&, ResolveReport& times);

// Collision response of Bridson, Fedkiw and Anderson 2002: impulses, then inelastic impact zones. Where a zone does not
// converge, as a last resort, obstacles that pinch it give way; if impacts are left even then, its motion is shortened
// toward the start of the step, which is clean. On return the straight motion x0 -> x1 is free of contact as tested by
// CCD (if report.clean). `path` may come from find_impacts with the same x0; on return it has every pair that is within
// the thickness at the new x1.
ResolveReport resolve(PairSearch&, const ContactWorld&, const Eigen::VectorXd& inverse_mass, const ResolveOptions&,
                      const Points& x0, Points& x1, PathPairs& path);

}  // namespace selvedge
