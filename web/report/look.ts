// From a cloud's row or dot to the cloud itself.

/** What the gallery can show; it fills this in where there is one. */
export const gallery = {
  has: (_set: string, _cloud: string): boolean => false,
  show: (_set: string, _cloud: string, _study: number, _variant: string): void => {},
};
