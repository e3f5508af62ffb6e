// What the pages of results have in common.
#pragma once
#include <string>
#include <vector>

namespace ibrdf {

// A section with a heading; body: markup.
std::string HtmlSection(const std::string& heading, const std::string& body);

// A list of sentences; empty where there is none.
std::string WarningSection(const std::vector<std::string>& warnings);

// The version, and where all numbers are.
std::string ReportFooter();

// A whole page in the look of reports; body: markup.
std::string HtmlPage(const std::string& title, const std::string& body);

}  // namespace ibrdf
