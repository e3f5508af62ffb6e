// Readers of the sections of a problem file. Each reads the map of its section,
// or what stands in the root's key, into its part of the problem, and reports
// to the reader's context what is wrong.
#pragma once
#include "ibrdf/io/problem.h"
#include "ibrdf/io/problem_reader.h"

namespace ibrdf {

// With kTextures the views have the files, so the image may have none.
// others: whether `views` or `images` stand beside it, which may have the
// files.
void ReadImageSpec(ProblemReader reader, bool others, ImageSpec* image);

// `images`, in place of the image's file. Kind, image, views and reflectance
// are read before, and its variation becomes kAlbedo.
void ReadOtherLights(ProblemReader* root, Problem* problem);

void ReadCamera(ProblemReader reader, Camera* camera);
void ReadViews(ProblemReader* root, ViewsSpec* views);

// `perspective`: the camera is.
void ReadGeometry(ProblemReader reader, bool perspective,
                  const ViewsSpec& views, GeometrySpec* geometry);
// Maps of normals and depth are in the camera's frame, so the camera may not be
// placed.
void CheckCameraStays(ProblemReader camera, const GeometrySpec& geometry);

void ReadReflectance(ProblemReader reader, ReflectanceSpec* reflectance);
// Makes the variation kNone with SolverEstimator::kMaximum, which refuses the
// others.
void SettleVariation(const SolverSpec& solver, ProblemReader reader,
                     ReflectanceSpec* reflectance);

void ReadIllumination(ProblemReader reader, IlluminationSpec* illumination);
// Puts what `auto` stands for in its place.
void SettlePrior(const SolverSpec& solver, IlluminationSpec* illumination);

void ReadLikelihood(ProblemReader reader, LikelihoodSpec* likelihood);
void ReadEffects(ProblemReader* root, EffectsSpec* effects);
void ReadSolver(ProblemReader reader, ProblemKind kind, SolverSpec* solver);

void ReadTruth(ProblemReader reader, TruthSpec* truth);
void ReadTexture(ProblemReader reader, ProblemKind kind, TextureSpec* texture);
void ReadUncertainty(ProblemReader reader, ProblemKind kind,
                     UncertaintySpec* uncertainty);

}  // namespace ibrdf
