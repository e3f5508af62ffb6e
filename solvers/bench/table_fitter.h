// What the sweep `merl-fit` compares: ways to make a table from a table.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "ibrdf/base/status.h"
#include "ibrdf/brdf/merl_table.h"

namespace ibrdf {

struct TableFitContext {
  std::string material;  // name of the table, without extension
  uint64_t seed = 1;
  int num_threads = 0;                      // <= 0: all
  const std::atomic<bool>* stop = nullptr;  // ends the fit (kInterrupted)
};

struct FittedTable {
  MerlTable table;       // valid at least where the fitted table is
  double seconds = 0.0;  // of the fit alone, without sampling the table
};

// Immutable: Fit may be called from several threads.
class TableFitter {
 public:
  virtual ~TableFitter() = default;

  // Cells that name it in results.csv, without comma, quote or bar. Several
  // fitters may share a method and differ in lobes or model.
  virtual std::string method() const = 0;
  virtual std::string lobes() const = 0;  // a number; empty: has none
  virtual std::string model() const = 0;  // name of weights; empty: analytic

  // Fails on tables that it cannot take; kInterrupted when stopped.
  virtual StatusOr<FittedTable> Fit(const MerlTable& table,
                                    const TableFitContext& context) const = 0;
};

using TableFitters = std::vector<std::shared_ptr<const TableFitter>>;

}  // namespace ibrdf
