// SPDX-License-Identifier: Apache-2.0
#include "study/reproduce/paper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "altiplan/error.hpp"
#include "host/base/install_root.hpp"
#include "host/config/config_check.hpp"

namespace altiplan::study {
namespace fs = std::filesystem;
namespace {

constexpr const char* kListHint = " (altiplan reproduce --list shows all)";

bool is_of_digits(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

bool is_named(const PaperName& name, const std::string& word) {
  return word == name.name || word == name.number + "_" + name.name ||
         (is_of_digits(word) && word.size() <= name.number.size() &&
          std::string(name.number.size() - word.size(), '0') + word == name.number);
}
}  // namespace

PaperName name_of(const fs::path& paper) {
  const std::string stem = paper.stem().string();
  const std::size_t line = std::min(stem.find('_'), stem.size());
  const std::string number = stem.substr(0, line);
  return is_of_digits(number) && line < stem.size() ? PaperName{number, stem.substr(line + 1)}
                                                    : PaperName{"", stem};
}

std::size_t PaperRuns::pairs_run(bool is_quick) const {
  return is_quick ? std::max<std::size_t>(1, std::size_t(std::lround(quick * double(pairs))))
                  : pairs;
}

double Paper::cpu_s(const std::vector<const ReproducibleRow*>& selected, bool quick) const {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  // By study and pipeline the time of each entry of scenarios, "" for all of them.
  std::map<std::pair<fs::path, std::string>, std::map<std::string, double>> times;
  for (const ReproducibleRow* row : selected) {
    const PaperRuns& of = runs[row->runs];
    for (const std::string& pipeline : row->pipelines) {
      const auto known = of.cpu_ms.find(pipeline);
      const double ms = known == of.cpu_ms.end() ? kUnknown : known->second;
      times[{of.study, pipeline}][of.scenarios] = ms / 1000 * double(of.pairs_run(quick));
    }
  }
  double sum = 0;
  for (const auto& [which, by_scenarios] : times) {
    double of_entries = 0;
    double of_all = 0;
    for (const auto& [scenarios, seconds] : by_scenarios) {
      (scenarios.empty() ? of_all : of_entries) += seconds;
    }
    const bool are_known = !std::isnan(of_all + of_entries);
    sum += are_known ? std::max(of_all, of_entries) : kUnknown;
  }
  return sum;
}

std::vector<const ReproducibleRow*> Paper::all_rows() const {
  std::vector<const ReproducibleRow*> all;
  for (const ReproducibleRow& row : rows) {
    all.push_back(&row);
  }
  return all;
}

std::vector<fs::path> installed_papers() {
  const fs::path folder = host::install_root() / "share/altiplan/configs/papers";
  std::vector<fs::path> files;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") {
      files.push_back(entry.path());
    }
  }
  if (files.empty()) {
    throw Error("no paper is installed: '" + folder.string() + "' has no .yaml file");
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> papers_named(const std::string& word) {
  if (word.find('/') != word.npos || word.ends_with(".yaml")) {
    return {word};
  }
  const std::vector<fs::path> all = installed_papers();
  if (word == "all") {
    return all;
  }
  std::vector<std::string> names{"all"};
  for (const fs::path& file : all) {
    const PaperName name = name_of(file);
    if (is_named(name, word)) {
      return {file};
    }
    names.insert(names.end(), {name.name, name.number});
  }
  throw Error("no paper is named " + excerpt(word) + kListHint + host::did_you_mean(word, names));
}

std::vector<const ReproducibleRow*> rows_named(const Paper& paper,
                                               const std::vector<std::string>& ids) {
  if (ids.empty()) {
    return paper.all_rows();
  }
  std::vector<std::string> known;
  for (const ReproducibleRow& row : paper.rows) {
    known.push_back(row.id);
  }
  for (const std::string& id : ids) {
    if (std::find(known.begin(), known.end(), id) == known.end()) {
      throw Error("paper " + paper.name.text() + " has no row " + excerpt(id) + kListHint +
                  host::did_you_mean(id, known));
    }
  }
  std::vector<const ReproducibleRow*> rows = paper.all_rows();
  std::erase_if(rows, [&](const ReproducibleRow* row) {
    return std::find(ids.begin(), ids.end(), row->id) == ids.end();
  });
  return rows;
}
}  // namespace altiplan::study
