#include "apparatus/report/page/page.hpp"

#include <fmt/format.h>

#include "apparatus/report/page/style.hpp"

namespace tremie::report {
namespace {

std::string paragraph(const std::string& text, const char* css = "") {
  if (text.empty()) return {};
  return fmt::format("<p{}>{}</p>\n", *css ? fmt::format(" class=\"{}\"", css) : "", escaped(text));
}

const char* css_of(VerdictKind kind) {
  return kind == VerdictKind::agrees    ? "verdict agrees"
         : kind == VerdictKind::differs ? "verdict differs"
                                        : "verdict";
}

std::string trust_html(const Trust& trust) {
  std::string text;
  for (const auto& reason : trust.reasons) text += paragraph("Not to be trusted: " + reason, "bad");
  if (!trust.trusted && trust.reasons.empty()) text += paragraph("Not to be trusted.", "bad");
  return text + paragraph(trust.text);
}

std::string figure_html(const Figure& figure) {
  const std::string caption =
      figure.caption.empty() ? "" : "<figcaption>" + escaped(figure.caption) + "</figcaption>";
  return fmt::format("<figure id=\"{}\">{}{}</figure>\n", escaped(figure.id), figure.svg, caption);
}

std::string numbers_html(const ValueTable& table) {
  std::string text = fmt::format("<section><h2>{}</h2>\n<table>\n", escaped(table.caption));
  for (const NumberRow& row : table.rows) {
    const std::string key =
        row.key.empty() ? "" : fmt::format("<span class=\"key\">{}</span>", escaped(row.key));
    const std::string unit = row.unit.empty() ? "" : "&nbsp;" + escaped(row.unit);
    text += fmt::format("<tr><td>{}{}</td><td class=\"n\">{}{}</td></tr>\n", escaped(row.words), key,
                        escaped(row.value), unit);
  }
  return text + "</table></section>\n";
}

std::string grid_html(const GridTable& table) {
  std::string text =
      fmt::format("<section><h2>{}</h2>\n<div class=\"wide\"><table><thead><tr>", escaped(table.caption));
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    text += fmt::format("<th{}>{}</th>", i > 0 ? " class=\"n\"" : "", escaped(table.columns[i]));
  text += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format("<td{}>{}</td>", i > 0 ? " class=\"n\"" : "", escaped(row[i]));
    text += "</tr>\n";
  }
  return text + "</tbody></table></div></section>\n";
}

std::string words_html(const std::vector<std::string>& words) {
  if (words.empty()) return {};
  std::string text = "<section><h2>Words</h2>\n";
  for (const auto& word : words) text += paragraph(word, "soft");
  return text + "</section>\n";
}

std::string made_html(const std::vector<Fact>& made) {
  if (made.empty()) return {};
  ValueTable table{"How it was made", {}};
  std::string text = "<section><h2>How it was made</h2>\n<table>\n";
  for (const Fact& fact : made)
    text += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(fact.what), escaped(fact.value));
  return text + "</table></section>\n";
}

std::string scene_html(const Page& page) {
  if (page.scene.empty()) return {};
  return fmt::format("<details><summary>{}</summary>\n<pre>{}</pre></details>\n", escaped(page.scene_words),
                     escaped(page.scene));
}

std::string body_of(const Page& page) {
  std::string text = fmt::format("<h1>{}</h1>\n", escaped(page.headline));
  if (!page.verdict.text.empty()) text += paragraph(page.verdict.text, css_of(page.verdict.kind));
  text += trust_html(page.trust);
  for (const auto& remark : page.remarks) text += paragraph(remark);
  if (page.moving) text += moving_html(*page.moving);
  text += "<div class=\"figures\">\n";
  for (const Figure& figure : page.figures) text += figure_html(figure);
  text += "</div>\n";
  for (const GridTable& table : page.grids) text += grid_html(table);
  text += "<div class=\"tables\">\n";
  for (const ValueTable& table : page.numbers) text += numbers_html(table);
  text += words_html(page.words) + made_html(page.made) + "</div>\n";
  return text + scene_html(page);
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string to_html(const Page& page) {
  std::string text =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(page.title) + "</title>\n<style>" + style_sheet + "</style></head>\n<body>\n";
  text += body_of(page);
  if (page.moving) text += std::string("<script>\n") + moving_script + "</script>\n";
  return text + "</body></html>\n";
}

}  // namespace tremie::report
