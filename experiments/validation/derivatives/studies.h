// One function per family of derivatives: each draws points, evaluates the
// library and its reference, and adds the errors to a table.
#pragma once
#include "experiments/validation/derivatives/error_table.h"
#include "ibrdf/flow/neural_brdf_model.h"

namespace ibrdf {
namespace derivatives {

struct StudyOptions {
  int points = 200;  // random ones of a row, fewer where each costs more
  unsigned seed = 1;
};

// Names of the rows: derivative, then kind of points.
void StudyFlows(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table);
void StudyLobes(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table);
void StudyTransport(const StudyOptions& options, ErrorTable* table);
void StudyHarmonics(const StudyOptions& options, ErrorTable* table);
void StudyGaussians(const StudyOptions& options, ErrorTable* table);
void StudyUnet(const StudyOptions& options, ErrorTable* table);
void StudyCosts(const StudyOptions& options, ErrorTable* table);
void StudyBaselines(const StudyOptions& options, ErrorTable* table);
void StudyJoint(const NeuralBrdfModel& model, const StudyOptions& options,
                ErrorTable* table);
void StudyMarginal(const NeuralBrdfModel& model, const StudyOptions& options,
                   ErrorTable* table);

}  // namespace derivatives
}  // namespace ibrdf
