export default function Maps() {
  return null;
}
