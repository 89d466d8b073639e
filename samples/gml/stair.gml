% A spiral stair around a column, as high as its axiom. The loop runs when the program is loaded; the height of each
% step is a formula of the shape. Axiom: a box, for example 4 x 6 x 4 metres.
/steps 30 var
/turns 1.75 var

/Column 1 0 terminal
/Step 1 1 terminal
/Post 1 2 terminal
/Rail 1 3 terminal

/Box axiom
Y size !height
X size 2 div !radius
!stair

:stair 0.4 -1.05 0.4 scale Column

0 1 steps 1 sub {
  !i
  :stair
  0 :i steps div turns mul 360 mul 0 rotate
  :radius 0.5 mul  :i 1 add steps div 0.5 sub :height mul  0 translate
  !place                                              % of this step
  :place :radius 0.95 mul 0.12 :radius 0.42 mul scale Step
  :place :radius 0.45 mul 0.55 0 translate 0.05 1 0.05 scale Post
  :place :radius 0.45 mul 1.05 0 translate 10 0 0 rotate 0.07 0.07 :radius 0.46 mul scale Rail
} for
