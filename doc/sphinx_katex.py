"""Equations by KaTeX from Debian's package libjs-katex, copied into the manual, so that it reads without a network.

Sphinx writes the TeX of an equation into the page, as it does for MathJax; KaTeX typesets it when the page is opened.
Another copy of KaTeX (its folder dist/): KATEX_DIR=/path/to/katex/dist doc/build.sh
"""

import os
import shutil

from sphinx.errors import ExtensionError
from sphinx.ext.mathjax import html_visit_displaymath, html_visit_math

KATEX = os.environ.get("KATEX_DIR", "/usr/share/javascript/katex")
STYLE = "katex/katex.min.css"
SCRIPTS = ["katex/katex.min.js", "katex/auto-render.js", "equations.js"]


def copy_katex(app):
    """What the pages use; of the fonts only woff2, the first that a browser takes."""
    if app.builder.format != "html":
        return
    if not os.path.exists(os.path.join(KATEX, "katex.min.js")):
        raise ExtensionError(f"no KaTeX in {KATEX}: install the Debian package libjs-katex")
    target = os.path.join(app.outdir, "_static", "katex")
    os.makedirs(os.path.join(target, "fonts"), exist_ok=True)
    for name in ("katex.min.css", "katex.min.js"):
        shutil.copy(os.path.join(KATEX, name), target)
    render = [os.path.join(KATEX, "contrib", name) for name in ("auto-render.min.js", "auto-render.js")]
    shutil.copy(next(path for path in render if os.path.exists(path)), os.path.join(target, "auto-render.js"))
    fonts = os.path.join(KATEX, "fonts")
    for name in os.listdir(fonts):
        if name.endswith(".woff2"):
            shutil.copy(os.path.join(fonts, name), os.path.join(target, "fonts"))


def add_scripts(app, pagename, templatename, context, doctree):
    if app.builder.format == "html" and app.env.get_domain("math").has_equations(pagename):
        app.add_css_file(STYLE)
        for script in SCRIPTS:
            app.add_js_file(script, loading_method="defer")


def setup(app):
    app.setup_extension("sphinx.ext.mathjax")    # its delimiters \( \) and \[ \] are options of that extension
    app.add_html_math_renderer("katex", (html_visit_math, None), (html_visit_displaymath, None))
    app.connect("builder-inited", copy_katex)
    app.connect("html-page-context", add_scripts)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
