#pragma once

// A report as plain data, and as one HTML file that needs no other: for a person who reads it, prints it or
// sends it on. Any command fills a Page; the page knows no apparatus. All text is escaped where it is written.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/report/page/moving_picture.hpp"

namespace tremie::report {

/// One number of a table. `value` as people write it ("348 ± 8"), `unit` ("mm"; empty: none), `key` as in
/// summary.json, for scripts (empty: none).
struct NumberRow {
  std::string words, value, unit, key;
};

/// Numbers below each other.
struct ValueTable {
  std::string caption;
  std::vector<NumberRow> rows = {};
};

/// A table with a heading a column; every row has as many cells as `columns`.
struct GridTable {
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows = {};
};

/// A picture that prints. An empty `caption` is left out. `svg` is one <svg> element, made by charts.hpp or shapes.hpp: markup, not escaped.
struct Figure {
  std::string id, caption, svg;
};

enum class VerdictKind { none, agrees, differs };

/// What there is to judge the result by, in a sentence.
struct Verdict {
  VerdictKind kind = VerdictKind::none;
  std::string text;  ///< empty: nothing to judge by
};

/// How far the result may be trusted, in words.
struct Trust {
  bool trusted = true;
  std::string text;                  ///< a sentence: error, checks
  std::vector<std::string> reasons;  ///< why it is not to be trusted
};

/// A line of "how it was made": "date", "24 November 2026".
struct Fact {
  std::string what, value;
};

struct Page {
  std::string title;     ///< of the browser's tab
  std::string headline;  ///< what was asked and what came out: "Mix A, …: 348 mm ± 8 mm"
  Verdict verdict;
  Trust trust;
  std::vector<std::string> remarks;  ///< paragraphs that a reader needs, few
  std::optional<MovingPicture> moving;
  std::vector<Figure> figures;
  std::vector<ValueTable> numbers;
  std::vector<GridTable> grids;
  std::vector<std::string> words;  ///< what a word means: "λ: …", a line each
  std::vector<Fact> made;
  std::string scene;  ///< the resolved scene, or what else stands for the input; folded on the screen
  std::string scene_words = "The scene, every value in SI";
};

/// The page as one file.
std::string to_html(const Page& page);

/// &, <, >, " and ' as HTML entities: for text and for attributes.
std::string escaped(const std::string& text);

/// One <svg> element of a page from (0, 0) to (width, height); `size`: further attributes, with a space before each.
std::string svg_element(const std::string& title, double width, double height, const std::string& size,
                        const std::string& content);

/// Date, version, commit, machine: the facts that every report ends with. `command` repeats the result.
std::vector<Fact> facts_of_this_run(const std::string& command);

}  // namespace tremie::report
