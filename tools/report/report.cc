#include "tools/report/report.h"

#include "tools/report/page_content.h"

namespace lodemark {
namespace {

// One small table per section: they flow side by side where there is room.
std::string TablesHtml(const Report& report) {
  // One run needs no heading on the page, but a screen reader still wants it.
  const bool several = report.runs.size() > 1;
  std::string head = std::string(several ? "<thead>" : "<thead class=\"hidden\">") +
                     "<tr><th scope=\"col\"><span class=\"hidden\">Measure</span></th>";
  for (const ReportRun& run : report.runs) {
    head += "<th scope=\"col\">" + EscapeHtml(run.name) + "</th>";
  }
  head += "<th scope=\"col\"><span class=\"hidden\">Unit</span></th></tr></thead><tbody>\n";
  std::string html;
  bool open = false;
  for (const ReportTableRow& row : report.table) {
    if (row.section || !open) {
      html += open ? "</tbody></table>\n" : "";
      html += "<table><caption>" + (row.section ? EscapeHtml(row.label) : "Results") +
              "</caption>" + head;
      open = true;
    }
    if (row.section) continue;
    html += "<tr><th scope=\"row\">" + EscapeHtml(row.label) + "</th>";
    for (std::size_t i = 0; i < report.runs.size(); ++i) {
      const bool known = i < row.values.size() && !row.values[i].empty();
      html += "<td>" + (known ? EscapeHtml(row.values[i]) : "–") + "</td>";
    }
    html += "<td class=\"unit\">" + EscapeHtml(row.unit) + "</td></tr>\n";
  }
  if (open) html += "</tbody></table>";
  return html;
}

std::string FiguresHtml(const Report& report) {
  std::string html = "<dl class=\"figures\">";
  for (const ReportFigure& figure : report.figures) {
    // As many colours as the page's script has.
    html += figure.run ? "<div class=\"of-run\" style=\"--run:var(--run" +
                             std::to_string(*figure.run % 5) + ")\">"
                       : "<div>";
    html += "<dt>" + EscapeHtml(figure.label) + "</dt><dd>" + EscapeHtml(figure.value);
    if (!figure.unit.empty())
      html += " <span class=\"unit\">" + EscapeHtml(figure.unit) + "</span>";
    html += "</dd>";
    if (!figure.note.empty()) html += "<dd class=\"note\">" + EscapeHtml(figure.note) + "</dd>";
    html += "</div>";
  }
  return html + "</dl>";
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      case '\0':
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string ReportHtml(const Report& report) {
  // The policy forbids every request, so nothing in the data can make the page call out.
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
      "form-action "
      "'none'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>";
  html +=
      EscapeHtml(report.title) + "</title>\n<style>\n" + kPageStyle + "</style>\n</head>\n<body>\n";
  html += "<header><div class=\"wide\"><h1>" + EscapeHtml(report.title) + "</h1><p>" +
          EscapeHtml(report.subtitle) + "</p></div></header>\n<main class=\"wide\">\n";
  html += FiguresHtml(report);
  html +=
      "<noscript><p class=\"card\">The drawings need JavaScript; the table does "
      "not.</p></noscript>\n";
  html +=
      "<div id=\"top\" class=\"charts\"></div>\n<section class=\"card results\" "
      "aria-label=\"Results\" style=\"--runs:" +
      std::to_string(report.runs.size()) + "\">" + TablesHtml(report) +
      "</section>\n<div id=\"charts\" class=\"charts\"></div>\n";
  html += "<div id=\"lists\"></div>\n</main>\n<footer class=\"wide\">" +
          EscapeHtml(report.generator) + "</footer>\n";
  html += "<script type=\"application/json\" id=\"data\">" + ReportDataJson(report) +
          "</script>\n<script>\n'use strict';\n(() => {\n" + kPageScript +
          "})();\n</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace lodemark
