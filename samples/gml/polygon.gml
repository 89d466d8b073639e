% Thesis figure 4.8: three vertices, each moved by operators of its own, become one polygon. Flattened, it is one chain
% of operators on one shape. Axiom: for example 4 x 0.5 x 4 metres, which says how large the prism is.
/Prism 0 0 terminal

/Box axiom
[
  (-0.5, -0.5) (0.05, 0) translate
  (0.45, -0.4) (0, 0.1) translate 10 rotate
  (0, 0.5) (1, 0.9) scale (0.1, 0) translate
]
prism Prism
