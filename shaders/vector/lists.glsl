// Where the lists of tiles lie behind the bins: a tile's list is how many paths there are and, for each, what it does
// to the tile and which one it is; or else the tile's colour.
uint listRoom() { return (header.listWords - 1) / 2; }
uint listOf(uint tile) { return kFirstBin + header.binCount * header.pathWords + tile * header.listWords; }
uint paintedTiles() { return listOf(header.tilesX * header.tilesY); }
uint crowdedTiles() { return paintedTiles() + header.tilesX * header.tilesY; }
