#pragma once

#include <string>
#include <vector>

namespace selvedge {

// The time feature: the time step [s] in a normalised column (HOOD), or a flag that is not normalised (ContourCraft).
enum class TimeFeature { timestep, is_init };

// The vertices that coarse edges join: those at even depths from a centre (HOOD, make_coarse_levels), or the centres of
// discs (make_coarse_discs).
enum class CoarseForm { depths, discs };

// The rest shape in the features of mesh and coarse edges: relative position and norm (HOOD), or length alone.
enum class RestFeature { vector, length };

// The obstacle vertex that a cloth vertex gets an edge to, if the distance is at most body_radius: the nearest vertex
// (HOOD), or the nearest vertex of the nearest face, which may be farther away (ContourCraft).
enum class BodyPartner { nearest_vertex, nearest_face };

// The velocity feature of obstacle vertices: pos - previous (HOOD), or target - pos.
enum class BodyVelocity { current, next };

// The velocity feature of cloth vertices: the state's velocity, or pos - previous (hood_cvpr).
enum class ClothVelocity { carried, difference };

// The treatment of pinned vertices (parity README, 1): HOOD moves them to their target before anything else.
// ContourCraft sees them there in mesh and coarse edges only.
enum class PinnedForm { moved, moved_for_mesh_edges };

// The end of a mesh edge that sends in the first half of its set. The second half is the reverse of the first.
enum class MeshOrder { larger_sends, smaller_sends };

// The rule that tells which cloth-cloth pairs attract: none does; by the vertex of a pair (released code); by all
// vertices of a pair (Grigorev et al. 2024, algorithm 2). The other pairs repel.
enum class ContourRule { all_repel, vertex, all_vertices };

// What the network's output is added to: the motion before, as an acceleration in space (the published networks), or
// the carried guess (physics/steppers/carried_stepper.hpp), in the frame of each vertex that its skinned target carries
// along (GraphState::frames). There an output of zero is the baseline `carried`, so that no mean is added to it.
enum class OutputBase { motion, carried };

// Which cloth vertices that are near each other get an edge, beside those of the mesh (Liao et al. 2024, section
// 3.1.2). Members are described where keys are bound to them: pipeline/training/training_options.cpp.
struct SpaceOptions {
  double radius = 0.02, radius_in_edges = 0;
  bool mesh_pairs = false, rest_pairs = true;
  int nearest = 0;
  int pairs_per_vertex = 32;
};

// The inputs of a model, as part of its architecture. The defaults are HOOD's.
struct FeatureOptions {
  // Nodes: velocity 3, type embedding, level embedding, normal 3, (dt,) mass | (is_init,) bending, mu, lambda. Columns
  // after | are not normalised.
  int type_columns = 9;
  int level_columns = 4;  // 0: no level embedding (fine15, fine48)
  int highest_level = 3;  // levels above are seen as this one
  bool log_mass = true;
  TimeFeature time = TimeFeature::timestep;
  ClothVelocity cloth_velocity = ClothVelocity::carried;
  BodyVelocity body_velocity = BodyVelocity::current;
  PinnedForm pinned = PinnedForm::moved;
  OutputBase base = OutputBase::motion;

  // More columns of cloth nodes, for our own networks (docs/training.md). Normalised ones: body 14, force 3, move 3,
  // guess 15. After the materials: flags, in the order pinned, near the body, pass. Obstacle vertices have zeros there.
  bool pinned_flag = false;
  bool body_inputs = false;          // relation to the nearest face of the body within body_radius: node_features.hpp
  bool force_inputs = false;         // GraphState::force, its length l compressed to log(1 + l / 1 mm)
  bool acceleration_inputs = false;  // GraphState::acceleration, after these
  bool pass_inputs = false;          // GraphState::guess - (x + velocity), and the flag GraphState::pass
  bool guess_inputs = false;         // the guess, and the solver's forces there: node_features.hpp
  double contour_force = 0;          // weight of the intersection contours in that force [N/m]; 0: none

  // Mesh and coarse edges: x_s - x_r 3 + 1, rest 3 + 1 or 1, (dt) | (is_init,) bending, mu, lambda.
  MeshOrder mesh_order = MeshOrder::larger_sends;
  RestFeature rest = RestFeature::vector;
  int coarse_levels = 3;                  // number of levels that are built; they give the vertex levels
  std::vector<int> coarse_sets{0, 1, 2};  // levels whose edges are sets of the graph
  CoarseForm coarse_form = CoarseForm::depths;
  bool shared_mesh_statistics = true;  // mesh and coarse edges have the same statistics
  bool strain_inputs = false;          // (l - L) / L at x and at the guess, after the rest columns
  bool edge_context = true;            // the columns dt or is_init, bending, mu, lambda
  bool approximate_centre = false;     // the centre is the middle of a long path, in place of the exact one

  // Edges between cloth and obstacle, both ways: now 3 + 1, next 3 + 1, (velocity 3 + 1, no dt | is_init), or dt.
  std::string body_key = "world_edge";  // empty: none
  BodyPartner body_partner = BodyPartner::nearest_vertex;
  double body_radius = 0.03;     // [m]
  bool next_body_first = false;  // hood_cvpr: the columns of the next pose come first
  bool body_edge_velocity = false;

  // Cloth-cloth edges from a vertex to the nearest vertex of a face: pos 3 + 1, previous 3 + 1, velocity 3 + 1, label
  // embedding | is_init, bending, mu, lambda. Sets repulsion_edge and attraction_edge.
  bool cloth_edges = false;
  double cloth_radius = 0.03;       // [m]
  int cloth_pairs_per_vertex = 32;  // on average; pairs beyond are left out and counted
  bool future_pinned = true;        // include pairs with pinned vertices where they will be (label 1)
  int label_columns = 4;
  ContourRule contours = ContourRule::vertex;
  bool attraction_edges = true;  // pairs that do not repel become edges; false: they are left out (paper, 4.3)

  // Edges of the set space_edge join cloth vertices near each other. They have the columns of mesh edges.
  bool space_edges = false;
  SpaceOptions space;
};

FeatureOptions hood_features();  // hood_final: 24 node, 12 mesh, 9 body columns
FeatureOptions hood_cvpr_features();
FeatureOptions fine_features();                // fine15, fine48: 20 node columns, no coarse levels
FeatureOptions contourcraft_features();        // released: 24, 9, 20 and 13 columns, four coarse levels
FeatureOptions senc_features();                // HOOD's, 27 node columns, space edges
FeatureOptions contourcraft_paper_features();  // two coarse levels, contours judged by all vertices of a pair

// The number of columns of each kind of row. The first `normalised` ones are normalised.
struct FeatureWidths {
  int all = 0, normalised = 0;
};
FeatureWidths node_widths(const FeatureOptions&);
int objective_columns(const FeatureOptions&);           // body, force, move, guess and acceleration of a node
bool sees_accelerations(const FeatureOptions&);         // whether GraphState::acceleration is among what it sees
FeatureWidths mesh_edge_widths(const FeatureOptions&);  // coarse edges too
FeatureWidths body_edge_widths(const FeatureOptions&);
FeatureWidths cloth_edge_widths(const FeatureOptions&);

// First columns of the learned embeddings: type and level in the rows of nodes, label in those of cloth-cloth edges.
struct EmbeddingColumns {
  int type = 0, level = 0, label = 0;
};
EmbeddingColumns embedding_columns(const FeatureOptions&);

// Keys of the edge sets of a graph, in its order: mesh_edge, coarse_edge.., body_key, repulsion_edge, attraction_edge,
// space_edge.
std::vector<std::string> edge_set_keys(const FeatureOptions&);

}  // namespace selvedge
