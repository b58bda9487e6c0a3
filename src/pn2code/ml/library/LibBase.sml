structure LibBase = struct
    exception NotFound
    exception Impossible of string
    exception Unimplemented of string
end
