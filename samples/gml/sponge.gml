% The Menger sponge of thesis figure 4.3. The rule's value counts recursions: there is a rule for each of its values.
/depth 3 var
/Cube 1 0 terminal

% shape n holes: a part that is in the middle of two axes is left out
/part { 1 gt { pop pop } { dup 1 eq { pop Cube } { 1 sub sponge } ifelse } ifelse } def
/alongZ { !h !n Z [ -1 { :n :h part } -1 { :n :h 1 add part } -1 { :n :h part } ] subdiv } def
/alongY { !h !n Y [ -1 { :n :h alongZ } -1 { :n :h 1 add alongZ } -1 { :n :h alongZ } ] subdiv } def
/sponge 1 { !n X [ -1 { :n 0 alongY } -1 { :n 1 alongY } -1 { :n 0 alongY } ] subdiv } rule

/Box axiom depth sponge
