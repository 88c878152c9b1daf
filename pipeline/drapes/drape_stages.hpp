#pragma once

#include "pipeline/drapes/drape_lessons.hpp"
#include "pipeline/drapes/training_stage.hpp"

namespace selvedge {

// A fresh network, for the drapes that are to be trained on; with its linear part, or without.
DrapeModel make_drape_model(const DrapeTrainingOptions&, const DrapeLessons&);
DrapeModel blank_drape_model(const DrapeTrainingOptions&, const DrapeLessons&);
// All that a stage has made of such a model.
void restore_model(const StageFile&, DrapeModel&);
// The same with fresh scales for a row that learns them.
void add_scales(const DrapeRow&, const DrapeTrainingOptions&, const DrapeLessons&, DrapeModel&);

// Stages that train what they are given a reference to.
TrainingStage backbone_stage(const DrapeTrainingOptions&, DrapeLessons&, DrapeModel&);
TrainingStage row_stage(const DrapeRow&, const DrapeTrainingOptions&, DrapeLessons&, DrapeModel&);
TrainingStage distance_stage(const DrapeTrainingOptions&, DrapeLessons&, PlainNetwork&);
PlainNetwork make_distance_network(const DrapeTrainingOptions&, const DrapeLessons&);

// Its errors on the bodies to measure on; with its arithmetic for one garment, a line for people.
DistanceErrors distance_errors_of(const DistanceOptions&, const DrapeLessons&, const PlainNetwork&);
std::string distance_text(const DistanceOptions&, const DrapeLessons&, const PlainNetwork&);

// Points of one body: on its surface, on the garment, each half of them with noise, and in the cube; as many of each.
void add_distance_samples(const DistanceOptions&, const DrapeLessons&, const DrapeBody&, int points, RandomStream&,
                          DistanceSamples&);

// Mean error of the drapes' vertices, before any layer [mm].
double mean_vertex_error(const DrapeModel&, const std::vector<std::unique_ptr<DrapeBody>>&);

}  // namespace selvedge
