#include "physics/solve/step_potential.hpp"

#include <algorithm>
#include <cassert>

#include "collision/geometry/parallel.hpp"

namespace selvedge {
namespace {

constexpr int potential_chunk = 128;  // of vertices or contacts

void prepare_inertia(const Scene& scene, const Eigen::VectorXd& masses, StepPotential& step) {
  const StepProblem& problem = *step.problem;
  const int vertices = scene.surface.vertex_count;
  const double h = problem.h;
  step.ballistic = *problem.x0 + h * *problem.v0;
  step.ballistic.rowwise() += h * h * problem.acceleration.transpose();
  step.inertia.resize(vertices);
  for (int i = 0; i < vertices; ++i) step.inertia[i] = masses[i] / (h * h);
  if (const VertexStarts* starts = problem.starts)
    for (int i = 0; i < vertices; ++i) {
      const double squared = starts->position_h[i] * starts->velocity_h[i];  // in place of h^2
      step.ballistic.row(i) =
          starts->x.row(i) + starts->position_h[i] * starts->v.row(i) + squared * problem.acceleration.transpose();
      step.inertia[i] = masses[i] / squared;
    }
  step.diagonal = step.inertia;

  step.drag.clear();
  const auto damped = [](const Cloth& cloth) { return cloth.material.mass_damping > 0; };
  if (std::none_of(scene.cloths.begin(), scene.cloths.end(), damped)) return;
  step.drag.assign(vertices, 0.0);
  for (const Cloth& cloth : scene.cloths)
    for (int i = cloth.first_vertex; i < cloth.first_vertex + cloth.vertex_count; ++i) {
      step.drag[i] = masses[i] * cloth.material.mass_damping / h;
      step.diagonal[i] += step.drag[i];
    }
}

void prepare_damping(const Scene& scene, StepScratch& scratch, StepPotential& step) {
  const Elastic& elastic = *step.elastic;
  const int vertices = scene.surface.vertex_count;
  const double h = step.problem->h;
  step.damping.clear();
  step.flat_damping.clear();
  step.flat_scale.assign(vertices, 1.0);
  const auto positive = [](double damping) { return damping > 0; };
  if (std::none_of(elastic.vertex_damping.begin(), elastic.vertex_damping.end(), positive)) return;
  elastic_derivatives(elastic, *step.problem->x0, scratch.assembly, nullptr, &step.damping, HessianForm::damping);
  for (Mat3& block : step.damping) block /= h;
  if (elastic.flat.rows() == 0) return;
  step.flat_damping.resize(vertices);
  for (int i = 0; i < vertices; ++i) {
    step.flat_damping[i] = elastic.vertex_damping[i] / h;
    step.flat_scale[i] += step.flat_damping[i];
  }
}

void prepare_contacts(int vertices, StepPotential& step) {
  step.contacts.clear();
  for (const ContactTerm& term : step.problem->contacts)
    step.contacts.push_back({term.nodes, term.weights, term.normal, 0, 0});
  const double h = step.problem->h;
  for (const WindFace& face : step.wind)
    step.contacts.push_back({{face.corners[0], face.corners[1], face.corners[2], -1},
                             {1.0 / 3, 1.0 / 3, 1.0 / 3, 0},
                             face.normal,
                             face.across / h,
                             face.along / h});
  step.lists = list_contacts(step.contacts, vertices);
}

// The added term's blocks come last and are others at every x.
void add_term(const AddedTerm& added, const Points& x, StepPotential& step, Points& gradient) {
  step.contacts.resize(step.problem->contacts.size() + step.wind.size());
  added.add_derivatives(x, gradient, step.contacts);
  step.lists = list_contacts(step.contacts, static_cast<int>(x.rows()));
}

// Row i of K0 (x - x0) / h.
Vec3 damping_force(const StepPotential& step, const Points& motion, int i) {
  Vec3 force = multiply_row(step.elastic->pattern, step.damping, motion, i);
  if (!step.flat_damping.empty()) force += step.flat_damping[i] * multiply_flat_row(step.elastic->flat, motion, i);
  return force;
}

double vertex_energy(const StepPotential& step, const Points& x, const Points& motion, int i) {
  double energy = 0;
  if (step.free[i]) {
    energy += 0.5 * step.inertia[i] * (x.row(i) - step.ballistic.row(i)).squaredNorm();
    if (!step.drag.empty()) energy += 0.5 * step.drag[i] * (x.row(i) - step.problem->x0->row(i)).squaredNorm();
  }
  if (!step.damping.empty()) energy += 0.5 * row(motion, i).dot(damping_force(step, motion, i));
  return energy;
}

// How far the middle of a triangle moves past the air, and the force that asks for it [N].
struct Drag {
  Vec3 slip, force;
};

Drag drag_of(const StepPotential& step, const WindFace& face, const Points& x) {
  const StepProblem& problem = *step.problem;
  Vec3 slip = -problem.h * problem.wind;
  for (const int corner : face.corners) slip += (row(x, corner) - row(*problem.x0, corner)) / 3;
  const Vec3 across = slip.dot(face.normal) * face.normal;
  return {slip, (face.across * across + face.along * (slip - across)) / problem.h};
}

double wind_energy(const StepPotential& step, const WindFace& face, const Points& x) {
  const Drag drag = drag_of(step, face, x);
  return 0.5 * drag.slip.dot(drag.force);
}

double contact_energy(const StepPotential& step, const Points& x, const ContactTerm& term) {
  double energy = contact_force(term, contact_gap(term, x)).energy;
  if (term.friction > 0 && term.normal_force > 0)
    energy += friction_force(term, contact_slip(term, *step.problem->x0, x), step.slip_width).energy;
  return energy;
}

void contact_derivatives(const ContactTerm& term, const Points& x0, const Points& x, double slip_width, Vec3& force,
                         ContactBlock& block) {
  const ContactForce push = contact_force(term, contact_gap(term, x));
  force = push.first * term.normal;
  block.normal_stiffness = push.second;
  block.tangent_stiffness = 0;
  if (!(term.friction > 0 && term.normal_force > 0)) return;
  const Vec3 slip = contact_slip(term, x0, x);
  block.tangent_stiffness = friction_force(term, slip, slip_width).factor;
  force += block.tangent_stiffness * slip;
}

}  // namespace

std::vector<char> free_vertices(const Scene& scene, const Eigen::VectorXd& masses) {
  std::vector<char> free(scene.surface.vertex_count);
  for (int i = 0; i < scene.surface.vertex_count; ++i) free[i] = masses[i] > 0;
  for (int pin : scene.pins) free[pin] = false;
  return free;
}

void prepare(const Scene& scene, const Elastic& elastic, const Eigen::VectorXd& masses, const StepProblem& problem,
             double slip_speed, StepScratch& scratch, StepPotential& step) {
  assert(problem.h > 0 && problem.x0->rows() == masses.size() && problem.v0->rows() == masses.size());
  step.elastic = &elastic;
  step.problem = &problem;
  step.slip_width = slip_speed * problem.h;
  if (step.free.empty()) step.free = free_vertices(scene, masses);
  prepare_inertia(scene, masses, step);
  prepare_damping(scene, scratch, step);
  step.wind = wind_faces(scene, *problem.x0, *problem.v0, problem.wind);
  prepare_contacts(scene.surface.vertex_count, step);
}

void energies(const StepPotential& step, const Points& x, StepScratch& scratch, std::vector<double>& energies) {
  energies.clear();
  append_elastic_energies(*step.elastic, x, energies);
  if (!step.damping.empty()) scratch.motion = x - *step.problem->x0;
  const int vertices = static_cast<int>(x.rows()), contacts = static_cast<int>(step.problem->contacts.size()),
            pushes = contacts + static_cast<int>(step.wind.size());
  const int vertex_chunks = chunks_of(vertices, potential_chunk),
            tasks = vertex_chunks + chunks_of(pushes, potential_chunk);
  const std::size_t first = energies.size();
  energies.resize(first + tasks);
#pragma omp parallel for schedule(static, 4) if (tasks > 8)
  for (int c = 0; c < tasks; ++c) {
    double sum = 0;
    if (c < vertex_chunks) {
      for (int i = c * potential_chunk; i < std::min(vertices, (c + 1) * potential_chunk); ++i)
        sum += vertex_energy(step, x, scratch.motion, i);
    } else {
      const int begin = (c - vertex_chunks) * potential_chunk;
      for (int k = begin; k < std::min(pushes, begin + potential_chunk); ++k)
        sum += k < contacts ? contact_energy(step, x, step.problem->contacts[k])
                            : wind_energy(step, step.wind[k - contacts], x);
    }
    energies[first + c] = sum;
  }
  if (step.problem->added) energies.push_back(step.problem->added->value(x));
}

void derivatives(StepPotential& step, const Points& x, StepScratch& scratch, Points& gradient, PairBlocks* hessian,
                 HessianForm form) {
  const Points& x0 = *step.problem->x0;
  elastic_derivatives(*step.elastic, x, scratch.assembly, &gradient, hessian, form);
  if (step.problem->added) add_term(*step.problem->added, x, step, gradient);
  if (!step.damping.empty()) scratch.motion = x - x0;
  const int vertices = static_cast<int>(x.rows()), contacts = static_cast<int>(step.problem->contacts.size()),
            faces = static_cast<int>(step.wind.size());
  scratch.contact_forces.assign(step.contacts.size(), Vec3::Zero());  // those of the added term are in its gradient
#pragma omp parallel if (vertices > 1000)
  {
#pragma omp for schedule(static)
    for (int c = 0; c < contacts; ++c)
      contact_derivatives(step.problem->contacts[c], x0, x, step.slip_width, scratch.contact_forces[c],
                          step.contacts[c]);
#pragma omp for schedule(static)
    for (int t = 0; t < faces; ++t) scratch.contact_forces[contacts + t] = drag_of(step, step.wind[t], x).force;
#pragma omp for schedule(static)
    for (int i = 0; i < vertices; ++i) {
      if (!step.free[i]) {
        gradient.row(i).setZero();
        continue;
      }
      Vec3 sum = step.inertia[i] * (row(x, i) - row(step.ballistic, i));
      if (!step.drag.empty()) sum += step.drag[i] * (row(x, i) - row(x0, i));
      if (!step.damping.empty()) sum += damping_force(step, scratch.motion, i);
      if (!step.lists.begin.empty())
        for (int k = step.lists.begin[i]; k < step.lists.begin[i + 1]; ++k)
          sum += step.lists.weight[k] * scratch.contact_forces[step.lists.contact[k]];
      gradient.row(i) += sum.transpose();
    }
    if (hessian && !step.damping.empty()) {
#pragma omp for schedule(static)
      for (int p = 0; p < static_cast<int>(hessian->size()); ++p) (*hessian)[p] += step.damping[p];
    }
  }
}

}  // namespace selvedge
