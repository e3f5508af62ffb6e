// A RadianceRenderer that a test writes as a function.
#pragma once
#include <functional>
#include <utility>
#include <vector>

#include "ibrdf/transport/radiance_renderer.h"

namespace ibrdf {
namespace testing {

class FunctionRenderer final : public RadianceRenderer {
 public:
  // false: as if progress had stopped it.
  using Function =
      std::function<bool(const std::vector<ShadingPoint>& points, double* L_o)>;
  explicit FunctionRenderer(Function function)
      : function_(std::move(function)) {}

  bool Render(const std::vector<ShadingPoint>& points, const Progress&,
              double* L_o) const override {
    return function_(points, L_o);
  }

 private:
  const Function function_;
};

}  // namespace testing
}  // namespace ibrdf
