import type { PartMaker } from '../part';
import { make_arm } from './arm';
import { make_cameras } from './cameras';
import { make_floor } from './floor';
import { make_forces } from './forces';
import { make_ghosts } from './ghosts';
import { make_shadow } from './shadow';
import { make_stand } from './stand';
import { make_tendons } from './tendons';
import { make_trail } from './trail';

/** All parts of the 3D view. A new kind needs one line here and one file. */
export const part_makers: PartMaker[] = [make_arm, make_shadow, make_tendons, make_forces, make_trail, make_ghosts, make_cameras, make_stand, make_floor];

