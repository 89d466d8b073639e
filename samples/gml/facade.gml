% A house with a facade on each side: floors and bays that fill it, windows with frames, a ground floor with doors.
% Axiom: a box, for example 18 x 14 x 12 metres.
/storeyHeight 3.2 var   % heights and widths in metres
/bay 2.6 var
/frame 0.12 var

/Wall 1 0 terminal
/Plinth 1 1 terminal
/Frame 1 2 terminal
/Glass 1 3 terminal
/Door 1 4 terminal
/Cornice 1 5 terminal
/Roof 1 6 terminal

% shape inset: what is in the middle goes to the procedure, and its border to Frame.
/framed {
  !inside
  Y [ frame { Frame } -1 { X [ frame { Frame } -1 :inside frame { Frame } ] subdiv } frame { Frame } ] subdiv
} def

/window 0 {
  X [ -1 { Wall } 1.3 { Y [ 0.8 { Wall } 1.6 { { Glass } framed } -1 { Wall } ] subdiv } -1 { Wall } ] subdiv
} rule

/door 0 {
  X [ -1 { Wall } 1.5 { Y [ 2.4 { { Door } framed } -1 { Wall } ] subdiv } -1 { Wall } ] subdiv
} rule

% A floor narrower than two bays stays a wall.
/storey 0 {
  X size bay 2 mul lt { Wall } { X bay tile window } ifelse
} rule

/ground 0 {
  Y [
    0.5 { Plinth }
    -1 { X [ -1 { X bay tile window } bay { door } -1 { X bay tile window } ] subdiv }
  ] subdiv
} rule

/facade 0 {
  Y [
    storeyHeight 0.6 add { ground }
    -1 { Y storeyHeight tile storey }
    0.4 { 0.3 extrude Cornice }
  ] subdiv
} rule

/Box axiom [ { 0.3 extrude Roof } { pop } { facade } ] compsplit
