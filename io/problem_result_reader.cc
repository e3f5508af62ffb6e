// The readers of the sections `truth`, `texture` and `uncertainty`.
#include "ibrdf/io/problem_section_readers.h"

namespace ibrdf {

void ReadTruth(ProblemReader reader, TruthSpec* truth) {
  reader.Read("brdf", &truth->brdf);
  reader.Read("illumination", &truth->illumination);
  reader.Read("frame", &truth->frame);
  reader.CheckNeeds("frame", reader.Has("illumination"));
}

void ReadTexture(ProblemReader reader, ProblemKind kind, TextureSpec* texture) {
  for (const char* key : {"width", "height"}) {
    reader.CheckNeeds(key, kind == ProblemKind::kTextures);
  }
  reader.Read("width", &texture->width);
  reader.Read("height", &texture->height);
}

void ReadUncertainty(ProblemReader reader, ProblemKind kind,
                     UncertaintySpec* uncertainty) {
  for (const char* key : {"evaluator", "order", "sigma", "shadows", "prior"}) {
    reader.CheckNeeds(key, kind == ProblemKind::kTextures);
  }
  reader.Read("evaluator", &uncertainty->evaluator);
  reader.Read("order", &uncertainty->order);
  reader.Read("sigma", &uncertainty->sigma);
  reader.Read("shadows", &uncertainty->shadows);
  reader.Read("prior", &uncertainty->prior);
}

}  // namespace ibrdf
