% A castle: four round towers, walls with battlements between them, a gate, and a keep.
% 40 x 12 x 40 metres, whatever the size of the axiom.
/tower 8 var          % width of a tower
/merlon 1.1 var       % width of a battlement

[ /Stone /Battlement ] 1 0 terminal
/TowerStone 0 1 terminal
/Roof 0 2 terminal
/Gate 1 3 terminal
/Window 1 4 terminal
/Yard 1 5 terminal

% shape fraction: moves it up by a fraction of its height
/up { !fraction Y size :fraction mul !h 0 :h 0 translate } def

% shape thickness procedure: what is in the middle of its depth
/core { !next !depth Z [ -1 { pop } :depth { :next exec } -1 { pop } ] subdiv } def

% shape n: the n corners of a regular polygon instead of a square
/rounded { !n [ 0 1 :n 1 sub { 360 mul :n div (0.5, 0) exch rotate } for ] prism } def

% shape n: n discs on top of each other, each narrower
/cone {
  !n
  Y size !h
  !whole
  0 1 :n 1 sub {
    !i
    :whole
    0 :i 0.5 add :n div 0.5 sub :h mul 0 translate
    :i :n div 1 sub -1 :n div :i :n div 1 sub scale
    16 rounded Roof
  } for
} def

% Every second piece of a row stays.
/battlements 0 { X merlon 2 mul tile X [ -1 { Battlement } -1 { pop } ] subdiv } rule

/wall 0 {
  Y [
    -1 { 1.8 { Stone } core }
    1.2 { Z [ -1 { pop } 0.4 { battlements } 1.2 { pop } 0.4 { battlements } -1 { pop } ] subdiv }
  ] subdiv
} rule

/gatehouse 0 {
  X [
    -1 { wall }
    7 {
      X [
        1.6 { 4 { Stone } core }
        -1 { Y [ 4.5 { 0.4 { Gate } core } -1 { 4 { Stone } core } 1.2 { 4 { battlements } core } ] subdiv }
        1.6 { 4 { Stone } core }
      ] subdiv
    }
    -1 { wall }
  ] subdiv
} rule

/roundTower 0 {
  -1 -1.3 -1 scale 0.115 up
  Y [
    -1 { -0.9 -1 -0.9 scale 16 rounded TowerStone }
    0.7 { 16 rounded TowerStone }
    4.5 { 9 cone }
  ] subdiv
} rule

% Halves until a room is small. Where it ends depends on the shape: the rule goes on through a dynamic edge.
/rooms 0 {
  X size 3 lt {
    Y 3.2 tile
    X [ -1 { Stone } 1 { Y [ -1 { Stone } 1.5 { Window } -1 { Stone } ] subdiv } -1 { Stone } ] subdiv
  } {
    X [ -1 { rooms } -1 { rooms } ] subdiv
  } ifelse
} rule

/keep 0 {
  -0.5 -1.7 -0.5 scale 0.206 up
  Y [
    -1 { [ { pop } { pop } { rooms } ] compsplit }
    0.5 { -1.08 -1 -1.08 scale Stone }
    1.2 { [ { pop } { pop } { 0.4 extrude X Z Y swapsize -90 0 0 rotate battlements } ] compsplit }
  ] subdiv
} rule

/turned { 0 90 0 rotate Z Y X swapsize } def

/Box axiom
40 12 40 scale
dup Y size -0.5 mul !floor 0 :floor 0 translate -0.9 0.2 -0.9 scale Yard
X [
  tower { Z [ tower { roundTower } -1 { turned wall } tower { roundTower } ] subdiv }
  -1 { Z [ tower { wall } -1 { keep } tower { gatehouse } ] subdiv }
  tower { Z [ tower { roundTower } -1 { turned wall } tower { roundTower } ] subdiv }
] subdiv
