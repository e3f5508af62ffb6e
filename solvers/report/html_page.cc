#include "ibrdf/solvers/report/html_page.h"

#include "ibrdf/base/version.h"
#include "ibrdf/solvers/report/html.h"
#include "ibrdf/solvers/report/report_style.h"

namespace ibrdf {

std::string HtmlSection(const std::string& heading, const std::string& body) {
  return "<section>\n" + HtmlElement("h2", heading) + "\n" + body +
         "</section>\n";
}

std::string WarningSection(const std::vector<std::string>& warnings) {
  if (warnings.empty()) return "";
  std::string items;
  for (const std::string& warning : warnings) {
    items += HtmlElement("li", warning) + "\n";
  }
  return "<section class=\"warnings\">\n" + HtmlElement("h2", "Warnings") +
         "\n<ul>\n" + items + "</ul>\n</section>\n";
}

std::string ReportFooter() {
  return HtmlElement("footer", std::string("ibrdf ") + kVersion +
                                   ". Numbers in full: result.json, beside "
                                   "this file. Logarithms are natural.") +
         "\n";
}

std::string HtmlPage(const std::string& title, const std::string& body) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n"
         "<meta charset=\"utf-8\" />\n"
         "<meta name=\"viewport\" content=\"width=device-width, "
         "initial-scale=1\" />\n"
         "<meta name=\"color-scheme\" content=\"light dark\" />\n" +
         HtmlElement("title", title + " - ibrdf") + "\n<style>\n" +
         kReportStyle + "</style>\n</head>\n<body>\n<main>\n" + body +
         "</main>\n</body>\n</html>\n";
}

}  // namespace ibrdf
