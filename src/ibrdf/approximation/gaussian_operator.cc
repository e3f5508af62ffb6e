#include "ibrdf/approximation/gaussian_operator.h"

#include <glog/logging.h>

#include <utility>

namespace ibrdf {

GaussianOperator::GaussianOperator(const GaussianLight& light,
                                   const GaussianTransport& transport,
                                   std::vector<ShadingPoint> points,
                                   const BrdfFunction& brdf)
    : light_(light),
      transport_(transport),
      points_(std::move(points)),
      tables_(transport.Tabulate(brdf)) {
  CHECK_EQ(light.count(), transport.num_lobes());
}

void GaussianOperator::ApplyLinear(const float* map, double* L_o) const {
  transport_.Render(points_, tables_, light_.Fit(map), L_o);
}

void GaussianOperator::ApplyTranspose(const double* adjoint,
                                      float* gradient) const {
  light_.Transpose(transport_.AmplitudeGradient(points_, tables_, adjoint),
                   gradient);
}

}  // namespace ibrdf
