# The site is made of the repository's own Markdown, so that every page reads the same there and here. Its root is the
# repository's root: a link between two pages is the relative path that it is in the tree.
project = "Tremie"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
root_doc = "docs/index"
include_patterns = ["docs/**.md", "tests/verification/*.md", "tests/verification/full/*.md", "CONTRIBUTING.md", "CHANGELOG.md", "README.md"]
exclude_patterns = ["build", ".git"]
html_theme = "alabaster"
html_theme_options = {"description": "Virtual test apparatus for fresh, thixotropic concrete", "fixed_sidebar": True, "page_width": "1080px"}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False
