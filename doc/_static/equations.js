// Typesets what Sphinx marks as an equation.
for (const equation of document.getElementsByClassName("math")) renderMathInElement(equation);
