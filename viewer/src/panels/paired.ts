// The picture that a camera's card shows: while something is measured in it, the one that it was measured in.

export interface Pictured<Image> {
  image: Image;
  time: number;
  number: number;
}

/** Pictures of a camera that wait for what is measured in them. */
const most_kept = 12;

/**
 * A measurement comes after its picture, when the next one may be there already. Drawn upon that one it would be off, so
 * its own picture stays until the next is measured.
 */
export class PairedPictures<Image> {
  private kept: Pictured<Image>[] = [];

  /** `copy` makes an image that stays when the original is closed; it may draw into a spare one. */
  constructor(private readonly copy: (image: Image, spare: Image | undefined) => Image) {}

  /**
   * Returns the picture to show. `measured` is the number of the picture with a result, null if there is none; pictures
   * are kept only while something is measured.
   */
  choose(newest: Pictured<Image> | null, measured: number | null, is_measuring: boolean): Pictured<Image> | null {
    if (!newest || !is_measuring) {
      this.kept = [];
      return newest;
    }
    const last = this.kept.at(-1);
    if (last?.number !== newest.number || last.time !== newest.time) this.keep(newest);
    return this.kept.find(({ number }) => number === measured) ?? newest;
  }

  private keep({ image, time, number }: Pictured<Image>): void {
    // A recording that goes back shows a picture again.
    const same = this.kept.filter((each) => each.number !== number);
    const spare = same.length >= most_kept ? same.shift()?.image : undefined;
    this.kept = [...same, { image: this.copy(image, spare), time, number }];
  }
}
