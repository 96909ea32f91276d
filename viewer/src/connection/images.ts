// Decoding of camera pictures. They are streamed: the next one is sent when the last was acknowledged.
import type { ImageMessage } from '../protocol/state';

export interface Picture {
  bitmap: ImageBitmap;
  time: number;
  number: number;
}

export class Pictures {
  private generation = 0;

  constructor(private readonly show: (camera: string, picture: Picture) => void) {}

  /** Pictures that are being decoded belong to another run and will not be shown. */
  reset(): void {
    ++this.generation;
  }

  /** Decodes a picture and shows it. Resolves afterwards, so that the picture can be acknowledged. */
  async take(camera: string, message: ImageMessage): Promise<void> {
    const generation = this.generation;
    const bitmap = await createImageBitmap(new Blob([message.file as BlobPart], { type: message.type }));
    if (generation !== this.generation) return bitmap.close();
    this.show(camera, { bitmap, time: message.time, number: message.number });
  }
}
