#pragma once

#include "pipeline/drapes/drape_lessons.hpp"
#include "pipeline/drapes/training_stage.hpp"

namespace selvedge {

// A fresh network for the drapes of the training, with and without its linear part.
DrapeModel make_drape_model(const DrapeTrainingOptions&, const DrapeLessons&);
DrapeModel blank_drape_model(const DrapeTrainingOptions&, const DrapeLessons&);
// Restores the result of a stage.
void restore_model(const StageFile&, DrapeModel&);
// Adds fresh scale networks for a row that learns them.
void add_scales(const DrapeRow&, const DrapeTrainingOptions&, const DrapeLessons&, DrapeModel&);

// The stages. They train the network that they get a reference to.
TrainingStage backbone_stage(const DrapeTrainingOptions&, DrapeLessons&, DrapeModel&);
TrainingStage row_stage(const DrapeRow&, const DrapeTrainingOptions&, DrapeLessons&, DrapeModel&);
TrainingStage distance_stage(const DrapeTrainingOptions&, DrapeLessons&, PlainNetwork&);
PlainNetwork make_distance_network(const DrapeTrainingOptions&, const DrapeLessons&);

// The network's errors on the test bodies; and these with its operations for one garment, as a line for people.
DistanceErrors distance_errors_of(const DistanceOptions&, const DrapeLessons&, const PlainNetwork&);
std::string distance_text(const DistanceOptions&, const DrapeLessons&, const PlainNetwork&);

// Adds as many points on the body's surface, on the garment and in the cube. Half of those on surfaces get noise.
void add_distance_samples(const DistanceOptions&, const DrapeLessons&, const DrapeBody&, int points, RandomStream&,
                          DistanceSamples&);

}  // namespace selvedge
