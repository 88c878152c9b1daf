#include "collision/penetration/penetration_regions.hpp"

#include <algorithm>
#include <map>

#include "collision/contour/find_contours.hpp"
#include "collision/geometry/disjoint_sets.hpp"

namespace selvedge {
namespace {

// The parts of the surface that bound a region, before it is measured.
struct RegionPlan {
  std::vector<int> contours;
  std::vector<CountedPart> parts;  // one for each component, or for each curve
  const ContourClosing* closing = nullptr;
};

// Curves between the same two components, which may be the same one.
struct CurveGroup {
  std::vector<const SurfaceCurve*> curves;  // in the order of contours
  std::vector<int> contours() const {
    std::vector<int> result;
    for (const SurfaceCurve* curve : curves)
      if (result.empty() || result.back() != curve->contour) result.push_back(curve->contour);
    return result;
  }
};

// An inside on the left of a curve counts +1 on side 0 of the contour and -1 on side 1: seen from there the contour
// runs backward.
int direction(const SurfaceCurve& curve) { return curve.side == 0 ? 1 : -1; }

class Planner {
 public:
  Planner(PartingSpace& space, const std::vector<SurfaceCurve>& curves, std::size_t contours)
      : space_(space), of_contour_(contours) {
    for (const SurfaceCurve& curve : curves) of_contour_[curve.contour].push_back(&curve);
  }

  // Each contour alone.
  void plan_alone(const std::vector<int>& contours, const ContourClosing* closing = nullptr) {
    for (const int contour : contours) {
      RegionPlan plan{{contour}, {}, closing};
      for (const SurfaceCurve* curve : of_contour_[contour]) {
        auto levels = part_alone(space_, *curve);
        if (!levels) break;
        CountedPart part{std::move(*levels), {{curve, direction(*curve)}}};
        for (auto& [vertex, times] : part.vertices) times *= direction(*curve);
        plan.parts.push_back(std::move(part));
      }
      if (plan.parts.size() == of_contour_[contour].size()) plans_.push_back(std::move(plan));
    }
  }

  // All contours of the group together; those that cannot be, alone.
  void plan_together(CurveGroup group) {
    std::vector<int> alone;
    for (std::vector<int> bad; !group.curves.empty();) {
      if (try_together(group, bad, alone)) break;
      if (bad.empty()) bad = group.contours();
      alone.insert(alone.end(), bad.begin(), bad.end());
      std::erase_if(group.curves,
                    [&](const SurfaceCurve* curve) { return std::ranges::find(bad, curve->contour) != bad.end(); });
    }
    plan_alone(alone);
  }

  std::vector<RegionPlan>& plans() { return plans_; }

 private:
  struct ParityPart {
    std::vector<const SurfaceCurve*> curves;
    PartedTogether parted;
    int first_patch = 0;
  };

  // False if the curves do not cut a component into inside and outside; `bad` then has the contours at fault, if known.
  bool try_together(const CurveGroup& group, std::vector<int>& bad, std::vector<int>& alone) {
    bad.clear();
    std::map<int, std::vector<const SurfaceCurve*>> by_component;
    for (const SurfaceCurve* curve : group.curves) by_component[curve->component].push_back(curve);
    std::vector<ParityPart> parts;
    int patches = 0;
    for (auto& [component, curves] : by_component) {
      std::vector<int> culprits;
      auto parted = part_together(space_, curves, culprits);
      for (const int place : culprits) bad.push_back(curves[place]->contour);
      if (!parted) return false;
      parts.push_back({std::move(curves), std::move(*parted), patches});
      patches += static_cast<int>(parts.back().parted.patch_vertices.size());
    }
    sign_and_plan(group.contours(), parts, patches, alone);
    return true;
  }

  struct Link {  // sign of the patch = sign of the contour times `sign`
    int contour, patch, sign;
  };

  // Contours connected by common patches make a region with these patches, if there are consistent signs.
  void sign_and_plan(const std::vector<int>& contours, const std::vector<ParityPart>& parts, int patches,
                     std::vector<int>& alone) {
    const auto place = [&](int contour) {
      return static_cast<int>(std::ranges::lower_bound(contours, contour) - contours.begin());
    };
    const int count = static_cast<int>(contours.size());
    std::vector<Link> links;
    DisjointSets sets(count + patches);
    for (const ParityPart& part : parts)
      for (std::size_t i = 0; i < part.curves.size(); ++i) {
        const int c = place(part.curves[i]->contour), patch = part.first_patch + part.parted.patch[i];
        links.push_back({c, patch, direction(*part.curves[i]) * part.parted.inside[i]});
        sets.join(c, count + patch);
      }
    std::vector<int> sign(static_cast<std::size_t>(count + patches), 0);
    std::vector<char> fits(sign.size(), 1);  // indexed by the lowest contour of a region
    for (int c = 0; c < count; ++c)
      if (sets.root(c) == c) sign[c] = 1;
    for (bool changed = true; changed;) {
      changed = false;
      for (const Link& link : links) {
        int &of_contour = sign[link.contour], &of_patch = sign[count + link.patch];
        if (of_contour != 0 && of_patch != 0 && of_patch != link.sign * of_contour) fits[sets.root(link.contour)] = 0;
        changed |= (of_contour == 0) != (of_patch == 0);
        if (of_contour == 0) of_contour = link.sign * of_patch;
        if (of_patch == 0) of_patch = link.sign * of_contour;
      }
    }
    std::map<int, RegionPlan> plans;
    for (int c = 0; c < count; ++c)
      if (fits[sets.root(c)])
        plans[sets.root(c)].contours.push_back(contours[c]);
      else
        alone.push_back(contours[c]);
    for (const ParityPart& part : parts) add_part(part, contours, sets, sign, plans);
    for (auto& [root, plan] : plans) plans_.push_back(std::move(plan));
  }

  void add_part(const ParityPart& part, const std::vector<int>& contours, DisjointSets& sets,
                const std::vector<int>& sign, std::map<int, RegionPlan>& plans) const {
    const int count = static_cast<int>(contours.size());
    std::map<int, CountedPart> by_region;
    for (std::size_t i = 0; i < part.curves.size(); ++i) {
      const int c = static_cast<int>(std::ranges::lower_bound(contours, part.curves[i]->contour) - contours.begin());
      by_region[sets.root(c)].curves.emplace_back(part.curves[i], direction(*part.curves[i]) * sign[c]);
    }
    for (std::size_t p = 0; p < part.parted.patch_vertices.size(); ++p) {
      const int patch = count + part.first_patch + static_cast<int>(p);
      for (const int v : part.parted.patch_vertices[p])
        by_region[sets.root(patch)].vertices.emplace_back(v, sign[patch]);
    }
    for (auto& [root, counted] : by_region)
      if (const auto plan = plans.find(root); plan != plans.end()) plan->second.parts.push_back(std::move(counted));
  }

  PartingSpace& space_;
  std::vector<std::vector<const SurfaceCurve*>> of_contour_;
  std::vector<RegionPlan> plans_;
};

Vec3 mean_crossing(const PartingSpace& space, const std::vector<ClippedPiece>& pieces) {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const ClippedPiece& piece : pieces)
    if (piece.from >= 0) {
      sum += position_of(space.closed.surface, space.x, space.crossings, piece.from);
      ++count;
    }
  return count > 0 ? Vec3(sum / count) : row(space.x, 0);
}

// Clips faces and measures the region. False if the region is not closed.
bool measure(PartingSpace& space, const RegionPlan& plan, PenetrationRegion& region) {
  region.contours = plan.contours;
  for (const CountedPart& part : plan.parts) {
    ClippedPart clipped = clip_faces(space.closed, space.crossings, part, space.count, space.cut);
    if (clipped.at_boundary) return false;
    region.faces.insert(region.faces.end(), clipped.faces.begin(), clipped.faces.end());
    region.pieces.insert(region.pieces.end(), clipped.pieces.begin(), clipped.pieces.end());
    for (const auto& [vertex, times] : part.vertices)
      if (times != 0) region.vertices.push_back(vertex);
  }
  region.centre = mean_crossing(space, region.pieces);
  for (const ClippedFace& clipped : region.faces) {
    const Vec3 normal = turned_normal(space.closed, space.x, clipped.face);
    const Vec3 corner = row(space.x, space.closed.surface.triangles(clipped.face, 0)) - region.centre;
    region.volume += normal.dot(corner) * clipped.covered() / 3;
    region.area += normal.norm() * std::abs(clipped.covered());
  }
  if (!plan.closing) return true;
  region.closing = *plan.closing;
  region.volume += closing_volume(space.closed, space.x, space.crossings, *plan.closing, region.centre);
  return true;
}

}  // namespace

Segments penetration_segments(const ClosedSurface& closed, const Segments& all) {
  Segments kept{all.crossings, {}, {}};
  for (const Segment& segment : all.segments) {
    const auto [a, b] = segment.triangle;
    if ((closed.is_fan(a) || closed.is_fan(b)) && closed.garment[a] != closed.garment[b]) continue;
    kept.segments.push_back(segment);
  }
  return kept;
}

Penetration find_penetration(const ClosedSurface& closed, const Points& x, const Segments& segments,
                             std::span<const Contour> contours, const PenetrationOptions& options) {
  Penetration result;
  result.contours.assign(contours.size(), ContourVolume::unassigned);
  result.crossings = segments.crossings;
  std::vector<SurfaceCurve> curves;
  std::map<int, ContourClosing> closings;
  for (int c = 0; c < static_cast<int>(contours.size()); ++c) {
    const CurveFailure failure = add_curves(closed, result.crossings, contours[c], c, curves);
    if (failure == CurveFailure::not_orientable) result.contours[c] = ContourVolume::not_orientable;
    if (failure != CurveFailure::open) continue;
    if (auto closing = close_open_contour(closed, x, contours[c], c, result.crossings, curves))
      closings.emplace(c, std::move(*closing));
    else
      result.contours[c] = ContourVolume::open;
  }
  PartingSpace space(closed, x, result.crossings, options.smaller);
  Planner planner(space, curves, contours.size());
  std::map<std::pair<int, int>, CurveGroup> groups;
  for (const auto& [contour, closing] : closings) planner.plan_alone({contour}, &closing);
  for (const SurfaceCurve& curve : curves) {
    if (closings.contains(curve.contour)) continue;
    const int a = contours[curve.contour].sides[0].component, b = contours[curve.contour].sides[1].component;
    groups[std::pair(std::min(a, b), std::max(a, b))].curves.push_back(&curve);
  }
  for (auto& [pair, group] : groups)
    if (options.regions == RegionRule::single)
      planner.plan_alone(group.contours());
    else
      planner.plan_together(std::move(group));
  for (const RegionPlan& plan : planner.plans()) {
    PenetrationRegion region;
    const bool is_closed = measure(space, plan, region);
    for (const int c : plan.contours) result.contours[c] = is_closed ? ContourVolume::enclosed : ContourVolume::open;
    if (is_closed) result.regions.push_back(std::move(region));
  }
  return result;
}

Penetration find_penetration(const ClosedSurface& closed, const Points& x, const PenetrationOptions& options,
                             Segments* segments) {
  const SheetView sheet{&closed.surface, &x};
  Segments found = penetration_segments(closed, find_segments(std::span(&sheet, 1)));
  Penetration result = find_penetration(closed, x, found, trace_contours(std::span(&sheet, 1), found), options);
  if (segments) *segments = std::move(found);
  return result;
}

}  // namespace selvedge
