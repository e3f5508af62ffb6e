#include "ibrdf/solvers/costs/log_radiance_cost.h"

#include <glog/logging.h>

#include <algorithm>
#include <cmath>

#include "ibrdf/light/log_map.h"

namespace ibrdf {
namespace {

// Residuals of L_o, and dr/dL_o of each; false where L_o is not finite.
bool FillResiduals(const std::vector<double>& L_o, const Observations& observed,
                   const RobustLogLikelihood& likelihood, double* residuals,
                   std::vector<double>* dr_dE) {
  LikelihoodDerivatives derivatives;
  const LikelihoodValue value =
      EvaluateLikelihood(L_o, observed, likelihood, &derivatives);
  std::copy(derivatives.residual.begin(), derivatives.residual.end(),
            residuals);
  if (dr_dE != nullptr) *dr_dE = std::move(derivatives.d_residual);
  return std::isfinite(value.cost);
}

void ScaleRows(const std::vector<double>& dr_dE,
               const std::vector<double>& dL_o, int columns, double* jacobian) {
  for (size_t i = 0; i < dr_dE.size(); ++i) {
    for (int p = 0; p < columns; ++p) {
      const size_t at = i * columns + p;
      jacobian[at] = dr_dE[i] * dL_o[at];
    }
  }
}

// As RenderLobeModel; render(fields, num_fields, out) as
// Transport::RenderLobes of `points` points.
template <typename Render>
bool CombineLobes(const Render& render, int points, const LobeModel& lobes,
                  const double* parameters, std::vector<double>* L_o,
                  std::vector<double>* dL_o) {
  const int stride = dL_o != nullptr ? 1 + lobes.code_size() : 1;
  const int num_fields =
      dL_o != nullptr ? lobes.num_fields() : lobes.num_lobes();
  const int columns = lobes.num_parameters();
  std::vector<float> fields;
  lobes.Tabulate(parameters, dL_o != nullptr, &fields);
  const size_t nodes = lobes.grid_shape().num_nodes();
  std::vector<const float*> pointers(num_fields);
  for (int f = 0; f < num_fields; ++f) pointers[f] = fields.data() + f * nodes;
  std::vector<float> out(static_cast<size_t>(points) * num_fields * 3);
  render(pointers.data(), num_fields, out.data());
  L_o->assign(static_cast<size_t>(points) * 3, 0.0);
  if (dL_o != nullptr) dL_o->assign(L_o->size() * columns, 0.0);
  const LobeMixture mixture = lobes.Mixture(parameters);
  const Eigen::Array3Xd colours = mixture.Colours();
  const Eigen::Array3Xd slopes = mixture.ColourSlopes();
  bool finite = true;
  for (int i = 0; i < points; ++i) {
    for (int k = 0; k < lobes.num_lobes(); ++k) {
      for (int c = 0; c < 3; ++c) {
        const auto field = [&](int f) {
          return static_cast<double>(
              out[(static_cast<size_t>(i) * num_fields + k * stride + f) * 3 +
                  c]);
        };
        const size_t row = static_cast<size_t>(i) * 3 + c;
        (*L_o)[row] += colours(c, k) * field(0);
        if (dL_o == nullptr) continue;
        const MutableLobeMixture d = lobes.Mixture(&(*dL_o)[row * columns]);
        for (int z = 0; z < d.code(k).size(); ++z) {
          d.code(k)[z] = colours(c, k) * field(1 + z);
        }
        d.log_colour(k)[c] = slopes(c, k) * field(0);
      }
    }
    for (int c = 0; c < 3; ++c) finite &= std::isfinite((*L_o)[3 * i + c]);
  }
  return finite;
}

}  // namespace

bool RenderLobeModel(const Transport& transport, const LobeModel& lobes,
                     const double* parameters, const float* map,
                     std::vector<double>* L_o, std::vector<double>* dL_o) {
  // Radiance of the patches after one bounce more each, and its tangents.
  std::vector<double> emitted, d_emitted;
  const auto render = [&](const Transport& of, const LightOperator* light,
                          std::vector<double>* out, std::vector<double>* d) {
    const bool finite = CombineLobes(
        [&](const float* const* fields, int num_fields, float* field_out) {
          of.RenderLobes(fields, num_fields, map, field_out,
                         emitted.empty() ? nullptr : emitted.data());
        },
        of.num_points(), lobes, parameters, out, d);
    if (d != nullptr && !d_emitted.empty()) {
      light->AddEmitted(d_emitted.data(), lobes.num_parameters(), d->data());
    }
    return finite;
  };
  std::optional<LightOperator> light;
  if (transport.bounces() > 0 && dL_o != nullptr) {
    light = transport.ByLight(lobes.Grid(parameters));
  }
  for (int b = 0; b < transport.bounces(); ++b) {
    std::vector<double> next, d_next;
    if (!render(*transport.patches(), light ? light->patches() : nullptr, &next,
                dL_o != nullptr ? &d_next : nullptr)) {
      return false;
    }
    emitted = std::move(next);
    d_emitted = std::move(d_next);
  }
  return render(transport, light ? &*light : nullptr, L_o, dL_o);
}

LobeRadianceCost::LobeRadianceCost(
    const Transport* transport, const LobeModel* lobes, std::vector<float> map,
    const Observations* observed, const RobustLogLikelihood& likelihood,
    const ReflectanceOperator* stored, bool ambient_unknown)
    : transport_(transport),
      lobes_(lobes),
      map_(std::move(map)),
      operator_(stored),
      observed_(observed),
      likelihood_(likelihood),
      ambient_unknown_(ambient_unknown) {
  if (operator_ == nullptr && IsStored(*transport)) {
    operator_ = &own_.emplace(transport->ByReflectance(map_.data()));
  }
  if (operator_ != nullptr) {
    CHECK_EQ(transport->num_points(), operator_->num_points());
  }
  mutable_parameter_block_sizes()->push_back(lobes->num_parameters());
  if (ambient_unknown_) mutable_parameter_block_sizes()->push_back(3);
  set_num_residuals(transport->num_points() * 3);
}

bool LobeRadianceCost::Evaluate(double const* const* parameters,
                                double* residuals, double** jacobians) const {
  const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
  double* const by_ambient =
      ambient_unknown_ && jacobians != nullptr ? jacobians[1] : nullptr;
  std::vector<double> L_o, dL_o, dr_dE;
  std::vector<double>* const tangents = wanted ? &dL_o : nullptr;
  RobustLogLikelihood likelihood = likelihood_;
  if (ambient_unknown_) {
    likelihood.ambient = Eigen::Map<const Eigen::Array3d>(parameters[1]);
  }
  const bool finite =
      operator_
          ? CombineLobes(
                [this](const float* const* fields, int num_fields, float* out) {
                  operator_->Apply(fields, num_fields, out);
                },
                transport_->num_points(), *lobes_, parameters[0], &L_o,
                tangents)
          : RenderLobeModel(*transport_, *lobes_, parameters[0], map_.data(),
                            &L_o, tangents);
  if (!finite) return false;
  if (!FillResiduals(L_o, *observed_, likelihood, residuals,
                     wanted || by_ambient != nullptr ? &dr_dE : nullptr)) {
    return false;
  }
  if (wanted) ScaleRows(dr_dE, dL_o, lobes_->num_parameters(), jacobians[0]);
  if (by_ambient != nullptr) {
    std::fill_n(by_ambient, 3 * dr_dE.size(), 0.0);
    for (size_t i = 0; i < dr_dE.size(); ++i) {
      by_ambient[3 * i + i % 3] = dr_dE[i];
    }
  }
  return true;
}

LogRadianceCost::LogRadianceCost(const Transport* transport,
                                 const LobeModel* lobes,
                                 const IlluminationUnet* unet,
                                 const Observations* observed,
                                 const RobustLogLikelihood& likelihood)
    : transport_(transport),
      lobes_(lobes),
      unet_(unet),
      observed_(observed),
      likelihood_(likelihood) {
  mutable_parameter_block_sizes()->push_back(lobes->num_parameters());
  mutable_parameter_block_sizes()->push_back(unet->num_weights());
  set_num_residuals(transport->num_points() * 3);
}

bool LogRadianceCost::Evaluate(double const* const* parameters,
                               double* residuals, double** jacobians) const {
  const int weights = unet_->num_weights();
  const std::vector<float> phi(parameters[1], parameters[1] + weights);
  LogMap log_map({unet_->options().width, unet_->options().height});
  IlluminationUnet::Workspace workspace, scratch;
  unet_->Forward(phi.data(), &workspace, log_map.data());
  std::vector<float> map, slopes;
  log_map.Exp(&map, &slopes);
  const bool want_lobes = jacobians != nullptr && jacobians[0] != nullptr;
  const bool want_weights = jacobians != nullptr && jacobians[1] != nullptr;
  std::vector<double> L_o, dL_o, dr_dE;
  if (!RenderLobeModel(*transport_, *lobes_, parameters[0], map.data(), &L_o,
                       want_lobes ? &dL_o : nullptr)) {
    return false;
  }
  if (!FillResiduals(L_o, *observed_, likelihood_, residuals,
                     want_lobes || want_weights ? &dr_dE : nullptr)) {
    return false;
  }
  if (want_lobes)
    ScaleRows(dr_dE, dL_o, lobes_->num_parameters(), jacobians[0]);
  if (want_weights) {
    const LightOperator light =
        transport_->ByLight(lobes_->Grid(parameters[0]));
    std::vector<double> adjoint(L_o.size(), 0.0);
    std::vector<float> by_map(map.size()), by_weight(weights);
    for (size_t row = 0; row < L_o.size(); ++row) {
      adjoint[row] = dr_dE[row];
      light.ApplyTranspose(adjoint.data(), by_map.data());
      adjoint[row] = 0.0;
      LogMap by_output(log_map.size());
      AddExpVjp(slopes, by_map, &by_output);
      unet_->Vjp(by_output.data(), workspace, &scratch, by_weight.data());
      std::copy(by_weight.begin(), by_weight.end(),
                jacobians[1] + row * weights);
    }
  }
  return true;
}

}  // namespace ibrdf
