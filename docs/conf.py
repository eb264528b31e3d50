import os

# The site is made of the repository's own Markdown, so that every page reads the same there and here. Its root is the
# repository's root: a link between two pages is the relative path that it is in the tree.
project = "Tremie"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
root_doc = "docs/index"
include_patterns = ["docs/**.md", "tests/verification/*.md", "tests/verification/full/*.md", "tests/benchmark/README.md", "CONTRIBUTING.md", "CHANGELOG.md", "README.md"]
exclude_patterns = ["build", ".git"]
html_theme = "alabaster"
html_theme_options = {"description": "Virtual test apparatus for fresh, thixotropic concrete", "fixed_sidebar": True, "page_width": "min(1080px, 100%)"}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sphinx = False
html_show_copyright = False
html_copy_source = False

# Formulas by KaTeX from Debian's libjs-katex, copied into the site, which then reads without a network; else by MathJax from
# Sphinx's own default address.
katex = "/usr/share/javascript/katex"
html_static_path, html_css_files, templates_path = ["site"], ["narrow.css"], ["templates"]
if os.path.isdir(katex):
    html_static_path.append(katex)
    html_css_files.append("katex.css")
    mathjax_path, mathjax_options = "katex.js", {"defer": "defer"}


def setup(app):
    if os.path.isdir(katex):
        app.add_js_file("contrib/auto-render.js", priority=900, defer="defer")
        app.add_js_file(None, priority=901, body="addEventListener('load', () => { if (window.katex) renderMathInElement(document.body); })")
