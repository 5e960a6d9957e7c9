// SPDX-License-Identifier: MIT OR Apache-2.0
//
// What is left to do for the frames inside never grows but by a new frame, and shrinks within three cycles in which those
// do something who may: so with a sink that is not for ever stalled, every frame ends.
module progress (
    input wire clock,
    input wire reset,
    input wire frame_ready,
    input wire start, // of a frame
    input wire willing, // whoever is asked does something
    input wire [9:0] left
);

    reg [3:1] watched = 3'd0;
    reg [3:1] willing_before = 3'd0;
    reg [3:1] new_frame = 3'd0;
    reg [3:1] waits = 3'd0; // a frame has waited for so many cycles
    reg [9:0] left_1;
    reg [9:0] left_2;
    reg [9:0] left_3;

    always @(posedge clock) begin
        watched <= {watched[2:1], !reset};
        willing_before <= {willing_before[2:1], willing};
        new_frame <= {new_frame[2:1], start};
        waits <= {waits[2:1], frame_ready && !reset};
        left_1 <= left;
        left_2 <= left_1;
        left_3 <= left_2;
`ifdef INVARIANTS
        if (watched[1] && !start && !new_frame[1]) begin
            assert (left <= left_1);
        end
        if ((watched == 3'd7) && (willing_before == 3'd7) && !start && (new_frame == 3'd0)) begin
            assert ((left_3 == 10'd0) || (left < left_3));
        end
        // A frame that waits is begun when nothing is in its way
        assert ((waits != 3'd7) || (left != 10'd0));
`endif
    end

endmodule
