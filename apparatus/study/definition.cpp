#include "apparatus/study/definition.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::study {
namespace {

using scene::complain;
using scene::Node;

void allow_only(const Node& table, const std::string& where, const std::vector<std::string>& known) {
  const auto* members = std::get_if<scene::Table>(&table.value);
  if (!members) complain(table, where, "must be a table");
  for (const auto& [key, node] : *members)
    if (std::find(known.begin(), known.end(), key) == known.end())
      complain(node, where.empty() ? key : where + "." + key,
               fmt::format("unknown key; allowed: {}{}", fmt::join(known, ", "),
                           scene::nearest_in_brackets(key, known, "")));
}

std::string text_at(const Node& table, const std::string& key, const std::string& where) {
  const Node* node = scene::find(table, key);
  if (!node) complain(table, where + key, "missing key");
  const auto* text = std::get_if<std::string>(&node->value);
  if (!text) complain(*node, where + key, "must be a string");
  return *text;
}

std::string choice_at(const Node& table, const std::string& key, const std::string& fallback,
                      const std::vector<std::string>& words) {
  const Node* node = scene::find(table, key);
  if (!node) return fallback;
  const auto* text = std::get_if<std::string>(&node->value);
  if (!text || std::find(words.begin(), words.end(), *text) == words.end())
    complain(*node, key,
             fmt::format("must be one of {}{}", fmt::join(words, ", "),
                         scene::nearest_in_brackets(text ? *text : "", words, "")));
  return *text;
}

std::int64_t whole_at(const Node& table, const std::string& key, std::int64_t fallback, std::int64_t least,
                      std::int64_t most) {
  const Node* node = scene::find(table, key);
  if (!node) return fallback;
  const auto* number = std::get_if<std::int64_t>(&node->value);
  if (!number || *number < least || *number > most)
    complain(*node, "design." + key, fmt::format("must be a whole number from {} to {}", least, most));
  return *number;
}

Factor factor_of(const Node& node, const scene::Schema& schema) {
  allow_only(node, "factor", {"key", "range", "values", "scale"});
  const std::string key = text_at(node, "key", "factor.");
  const Node* range = scene::find(node, "range");
  const Node* values = scene::find(node, "values");
  if (!range == !values) complain(node, "factor " + key, "needs range or values, one of the two");
  const bool log = choice_at(node, "scale", "linear", {"linear", "log"}) == "log";
  return read_factor(key, range ? *range : *values, range != nullptr, log ? Scale::log : Scale::linear,
                     schema);
}

void read_factors(const Node& document, const scene::Schema& schema, Definition& study) {
  const Node* list = scene::find(document, "factor");
  const auto* factors = list ? std::get_if<scene::Array>(&list->value) : nullptr;
  if (!factors || factors->empty())
    complain(list ? *list : document, "factor", "a study needs at least one [[factor]]");
  for (const Node& node : *factors) {
    study.factors.push_back(factor_of(node, schema));
    for (std::size_t i = 0; i + 1 < study.factors.size(); ++i)
      if (study.factors[i].key == study.factors.back().key)
        complain(node, study.factors[i].key, "is a factor twice");
  }
}

void read_design(const Node& document, Definition& study) {
  const Node* design = scene::find(document, "design");
  if (!design) complain(document, "design", "missing table [design], with method and runs");
  allow_only(*design, "design", {"method", "runs", "levels", "seed"});
  const std::string method =
      choice_at(*design, "method", "latin_hypercube", {"grid", "latin_hypercube", "sobol"});
  study.method = method == "grid"    ? Method::grid
                 : method == "sobol" ? Method::sobol
                                     : Method::latin_hypercube;
  const bool grid = study.method == Method::grid;
  const char* foreign = grid ? "runs" : "levels";
  if (const Node* node = scene::find(*design, foreign))
    complain(*node, std::string("design.") + foreign,
             grid ? "a grid has levels for each factor in place of runs" : "only a grid has levels");
  study.levels = static_cast<std::size_t>(whole_at(*design, "levels", 5, 2, 1000));
  study.runs = static_cast<std::size_t>(whole_at(*design, "runs", 100, 1, 1000000));
  study.seed = static_cast<std::uint64_t>(whole_at(*design, "seed", 1, 0, 4000000000));
}

void read_results(const Node& document, const scene::Apparatus& apparatus, Definition& study) {
  const Node* read = scene::find(document, "read");
  if (read) allow_only(*read, "read", {"results"});
  const Node* list = read ? scene::find(*read, "results") : nullptr;
  if (!list) {
    for (const auto& headline : apparatus.headlines) study.results.push_back(headline.name);
    return;
  }
  const auto* names = std::get_if<scene::Array>(&list->value);
  if (!names || names->empty()) complain(*list, "read.results", "must be a list of at least one name");
  for (const Node& node : *names) {
    const auto* name = std::get_if<std::string>(&node.value);
    if (!name) complain(node, "read.results", "must be a list of names, like \"spread_mm\"");
    study.results.push_back(*name);
  }
}

/// A key that the base scene has no place for makes every row fail. Some rows may: factors limit each other.
void refuse_what_never_runs(const Definition& study) {
  std::string why;
  for (const double share : {0.5, 0.0, 1.0}) try {
      std::vector<std::string> overrides;
      for (const Factor& factor : study.factors)
        overrides.push_back(factor.key + "=" + level_at(factor, share).text);
      scene::load({study.base, overrides}, scene::all_keys());
      return;
    } catch (const scene::InputError& error) {
      if (why.empty()) why = error.what();
    }
  throw scene::InputError(fmt::format(
      "{}: no row of this study that was tried is a valid scene; the row at mid-range fails with:\n{}",
      study.file.string(), why));
}

}  // namespace

Definition read_definition(const std::filesystem::path& file) {
  const Node document = scene::parse_file(file);
  allow_only(document, "", {"base", "factor", "design", "read"});
  Definition study;
  study.name = file.stem().string();
  study.file = file;
  study.base = text_at(document, "base", "");
  if (study.base.is_relative()) study.base = file.parent_path() / study.base;
  const auto loaded = scene::load({study.base}, scene::all_keys());
  read_factors(document, loaded.schema, study);
  read_design(document, study);
  const auto base = scene::read(study.base);
  study.resolved_base = base.resolved;
  read_results(document, *base.functions, study);
  refuse_what_never_runs(study);
  return study;
}

}  // namespace tremie::study
