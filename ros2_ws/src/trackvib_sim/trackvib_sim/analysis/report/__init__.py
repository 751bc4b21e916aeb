"""The report: one HTML file about one bag, or about several side by side. Whatever a bag tells is escaped."""

from ...extras import require

require("report", "jinja2", "plotly")
