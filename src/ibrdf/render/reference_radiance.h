// The reference renderer with a reflectance.
#pragma once
#include <utility>
#include <vector>

#include "ibrdf/brdf/brdf_grid.h"
#include "ibrdf/brdf/merl_table.h"
#include "ibrdf/render/reference_renderer.h"
#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {

class ReferenceRadiance final : public RadianceRenderer {
 public:
  // Renderer, table and emitted light must outlive this. Several threads may
  // call the function at a time.
  ReferenceRadiance(const ReferenceRenderer& renderer, const MerlTable& table,
                    const EmittedLight& emitted = {},
                    QuadratureRules rules = QuadratureRules::kBoth)
      : renderer_(renderer), table_(&table), emitted_(emitted), rules_(rules) {}
  ReferenceRadiance(const ReferenceRenderer& renderer, BrdfFunction brdf,
                    const EmittedLight& emitted = {},
                    QuadratureRules rules = QuadratureRules::kBoth)
      : renderer_(renderer),
        function_(std::move(brdf)),
        emitted_(emitted),
        rules_(rules) {}

  // A reflectance that varies, and its sharpest lobe (ReferenceRenderer).
  ReferenceRadiance(const ReferenceRenderer& renderer, SurfaceBrdf brdf,
                    BrdfFunction sharpest, const EmittedLight& emitted)
      : renderer_(renderer),
        function_(std::move(sharpest)),
        surface_(std::move(brdf)),
        emitted_(emitted) {}

  // `progress` is called between steps of some thousand points, well below a
  // second each.
  bool Render(const std::vector<ShadingPoint>& points, const Progress& progress,
              double* L_o) const override;

 private:
  const ReferenceRenderer& renderer_;
  const MerlTable* table_ = nullptr;  // null: the function
  const BrdfFunction function_;
  const SurfaceBrdf surface_;  // set: `function_` is its sharpest
  const EmittedLight emitted_;
  const QuadratureRules rules_ = QuadratureRules::kBoth;
};

}  // namespace ibrdf
