#include "ibrdf/solvers/photograph_check/check_words.h"

#include "ibrdf/base/format.h"

namespace ibrdf {
namespace {

std::string Number(double value) { return Format("%.3g", value); }
std::string Two(double value) { return Format("%.2f", value); }
std::string Three(double value) { return Format("%.3f", value); }

std::string ImageLine(const PhotographCheck& check) {
  std::string line = SizeName(check.width, check.height) +
                     " pixels; curve: " + check.curve + "; exposure " +
                     Number(check.exposure);
  if (check.counts.used > 0) {
    line += "; radiance " + Number(check.radiance_1) + " to " +
            Number(check.radiance_99) + " (1 % to 99 %)";
  }
  return line;
}

std::string ObjectLine(const PhotographCheck& check) {
  std::string line = std::to_string(check.counts.object) + " pixels";
  if (!check.has_mask) return line + "; no mask";
  line += "; the mask has " + std::to_string(check.mask_pixels);
  if (check.overlap.has_value()) {
    line += "; overlap of mask and shape " + Two(*check.overlap);
  }
  return line;
}

std::string CountsLine(const PhotographCheck& check) {
  const ObjectPixelCounts& counts = check.counts;
  return std::to_string(counts.used) + " used; " +
         std::to_string(counts.clipped) + " clipped, " +
         std::to_string(counts.zero) + " zero, " +
         std::to_string(counts.negative) + " negative, " +
         std::to_string(counts.not_finite) + " not finite, " +
         std::to_string(check.missing) + " missing";
}

std::string SpreadLine(const PhotographCheck& check) {
  const LikeNormalsSpread& like = check.like_normals;
  const std::string share = Number(100.0 * like.share) + " % of the pixels";
  if (like.pixels == 0) return "none are seen at several places";
  const std::string floor =
      like.HasFloor()
          ? "without shadows and bounces, no material and distant light come "
            "below a misfit of " +
                Three(like.Floor())
          : "before so near a camera they mirror different light, so this sets "
            "no floor to the misfit";
  return "at several places (" + share + ") log radiance differs by " +
         Three(like.log_radiance) + ", log colour by " +
         Three(like.log_colour) + "; " + floor;
}

std::string NormalsLine(const PhotographCheck& check) {
  std::string line = NormalsVerdict(check) + " (disagreement";
  for (size_t k = 0; k < 3 && k < check.normals.size(); ++k) {
    line += (k == 0 ? " " : "; ") + Two(check.normals[k].disagreement) + " " +
            NameOf(check.normals[k].hypothesis);
  }
  return line + ")";
}

// Where no like normals tell paint from light.
std::string ColourEdges(const PhotographCheck& check) {
  const std::string length = Two(check.colour_steps);
  const std::string edges =
      "Its sharp edges of colour add up to " + length + " of its size";
  if (check.MayBePainted()) {
    return edges + ": a solve compares paint with mirrored light";
  }
  return (length == Two(0.0) ? "It has no sharp edges of colour"
                             : edges + ", too little for paint") +
         "; if it is painted, set reflectance.variation: albedo";
}

}  // namespace

std::string NormalsVerdict(const PhotographCheck& check) {
  if (check.normals.empty()) return "";
  const double least = check.normals.front().disagreement;
  std::string names;
  int together = 0;
  for (const NormalScore& score : check.normals) {
    if (score.disagreement - least >= kToldApart) break;
    names +=
        (together == 0 ? "" : " or ") + std::string(NameOf(score.hypothesis));
    ++together;
  }
  return together == 1 ? names + ": most plausible"
                       : names + ": not told apart";
}

std::string ColourVerdict(const PhotographCheck& check) {
  const ColourSpread& colours = check.colours;
  const std::string share = Number(100.0 * colours.share) + " % of the pixels";
  if (!colours.observable) {
    return "cannot be told: " + share +
           " have a like normal elsewhere on the object. " + ColourEdges(check);
  }
  return (SaysSeveralMaterials(colours) ? "several materials"
                                        : "may be one material") +
         std::string(": colours of like normals far apart differ by ") +
         Three(colours.excess) + " (several materials from " +
         Two(kSeveralMaterials) + ", " + share + ")";
}

std::vector<CheckFinding> CheckFindings(const PhotographCheck& check) {
  std::vector<CheckFinding> findings = {{"image", ImageLine(check)},
                                        {"object", ObjectLine(check)},
                                        {"its pixels", CountsLine(check)},
                                        {"like normals", SpreadLine(check)},
                                        {"materials", ColourVerdict(check)}};
  if (!check.normals.empty()) {
    findings.push_back({"normals", NormalsLine(check)});
  }
  return findings;
}

std::vector<std::string> CheckWarnings(const PhotographCheck& check,
                                       const std::string& image_file,
                                       const std::string& normals_file,
                                       MaterialsSought sought) {
  std::vector<std::string> warnings;
  if (check.SeveralMaterials() && sought != MaterialsSought::kLabelled) {
    warnings.push_back(
        image_file +
        ": the object looks painted or of several materials: pixels of like "
        "normals far apart differ in colour by " +
        Three(check.colours.excess) +
        " (log of a ratio of channels, noise taken off). " +
        (sought == MaterialsSought::kPainted
             ? "Its albedo is taken to vary, one gloss over all; for one "
               "material set reflectance.variation: none"
             : "One material explains that as mirrored light. Mask one "
               "material alone, say where which is (reflectance.labels), or "
               "look "
               "for paint: reflectance.variation: albedo"));
  }
  if (const NormalScore* better = check.BetterNormals()) {
    warnings.push_back(normals_file +
                       ": the normals would agree better with a surface and "
                       "its outline if \"" +
                       std::string(NameOf(better->hypothesis)) +
                       "\" (disagreement " + Two(better->disagreement) +
                       ", as given " + Two(check.AsGiven()->disagreement) +
                       "): " + AdviceFor(better->hypothesis));
  }
  return warnings;
}

}  // namespace ibrdf
