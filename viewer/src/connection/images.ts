// Decoding of camera pictures. They are streamed: the next one is sent when the last was acknowledged.
import type { ImageMessage } from '../protocol/state';

export interface Picture {
  bitmap: ImageBitmap;
  time: number;
  number: number;
}

export class Pictures {
  private generation = 0;
  /** Of each camera: what was decoding before is not shown after. */
  private readonly newest = new Map<string, number>();
  private count = 0;

  constructor(private readonly show: (camera: string, picture: Picture) => void) {}

  /** Pictures that are being decoded belong to another run and will not be shown. */
  reset(): void {
    ++this.generation;
  }

  /** Likewise of one camera: it has no picture now. */
  forget(camera: string): void {
    this.newest.set(camera, ++this.count);
  }

  /** Decodes a picture and shows it; resolves when that is done, so that it can be acknowledged. */
  async take(camera: string, message: ImageMessage): Promise<void> {
    const generation = this.generation;
    const place = ++this.count;
    this.newest.set(camera, place);
    const bitmap = await createImageBitmap(new Blob([message.file as BlobPart], { type: message.type }));
    if (generation !== this.generation || this.newest.get(camera) !== place) return bitmap.close();
    this.show(camera, { bitmap, time: message.time, number: message.number });
  }
}
