(* in front of every case, in all engines *)
fun check_int (i : int) = i;
fun show_int (i : int) = Int.toString (check_int i);
fun show_real x =
  if Real.isNan x then "nan" else if Real.== (x, 0.0) then (if Real.signBit x then "~0" else "0") else if Real.isFinite x then Real.fmt (StringCvt.SCI (SOME 11)) x
  else if x > 0.0 then "inf" else "~inf";
fun show_string s = "\"" ^ String.toString s ^ "\"";
fun show_char c = "#\"" ^ Char.toString c ^ "\"";
fun show_order LESS = "LESS" | show_order EQUAL = "EQUAL" | show_order GREATER = "GREATER";
fun show_substring s = "<" ^ String.toString (Substring.string s) ^ ">";
fun show_list show xs = "[" ^ String.concatWith ", " (List.map show xs) ^ "]";
fun show_option show NONE = "NONE" | show_option show (SOME x) = "SOME " ^ show x;
fun show_ref show r = "ref " ^ show (!r);
fun show_vector show v = "#" ^ show_list show (Vector.foldr (op ::) [] v);
fun show_array show a = "#" ^ show_list show (Array.foldr (op ::) [] a);
