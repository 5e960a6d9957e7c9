// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Whose turn the lanes are: starts the programs of the frames under way.
//
// A frame's first program gives its weights and what its search needs. Where a field is put together in the lanes, the
// second gives what is left of the stress for it, and the third, once the search has found the friction, the field. A
// program starts in the cycle after the last issue of the one before, if its data are there.

`default_nettype none

module sptfra_turns #(
    // 1, or 3 with a field that the lanes put together
    parameter PROGRAMS = 3,
    // Frames that have a place until they are released; 0: nothing of a frame stays
    parameter PLACES = 4,
    // 1: the next frame's first program goes ahead of a field whose search is not finished, best for the interval; 0:
    // it waits until this field is under way, best for the latency under load
    parameter INTERVAL = 1
) (
    input  wire clock,
    input  wire reset,
    // Data
    input  wire frame_ready, // a frame waits in its bank
    input  wire search_over, // one cycle: a search has handed its result on
    input  wire residual_written, // one cycle: the second program's results are there
    input  wire friction_known, // until the field is started
    input  wire frame_released, // one cycle: a frame has left
    // Lanes
    input  wire issued, // last issue of a program
    output reg  [PROGRAMS-1:0] start,
    output reg  bank // of the stress of the frame started last
);

    generate
        if ((PROGRAMS < 1) || (PROGRAMS > 3)) begin : gen_check_programs
            sptfra_error_programs_must_be_1_to_3 invalid ();
        end
    endgenerate

    reg busy;
    reg [1:0] searches_due; // frames started whose search is not over: two at most have a place in Op
    reg [2:0] frames_held; // started and not released
    wire may_field;
    wire may_residual;
    wire field_waits; // and the next frame for it
    wire room = (PLACES == 0) || (frames_held != PLACES);
    wire may_frame = frame_ready && (searches_due != 2'd2) && room && !field_waits;
    wire free = !busy || issued;

    always @(posedge clock) begin
        if (free) begin
            busy <= may_field || may_residual || may_frame;
        end
        start[0] <= free && may_frame && !may_field && !may_residual;
        if (free && may_frame && !may_field && !may_residual) begin
            bank <= !bank;
        end
        searches_due <= searches_due + {1'b0, start[0]} - {1'b0, search_over};
        frames_held <= frames_held + {2'd0, start[0]} - {2'd0, frame_released};
        if (reset) begin
            start[0] <= 1'b0;
            busy <= 1'b0;
            bank <= 1'b1;
            searches_due <= 2'd0;
            frames_held <= 3'd0;
        end
    end

    generate
        if (PROGRAMS == 3) begin : gen_field
            reg residual_due; // started, but for its second program
            reg field_due; // second program started, but for its third
            reg residual_there;
            reg [1:0] fields_held; // field started and not released: two at most

            assign may_field = field_due && residual_there && friction_known && (fields_held != 2'd2);
            assign may_residual = residual_due && !field_due;
            assign field_waits = residual_due || ((INTERVAL == 0) && field_due);

            always @(posedge clock) begin
                start[2] <= free && may_field;
                start[1] <= free && !may_field && may_residual;
                if (free && may_field) begin
                    field_due <= 1'b0;
                    residual_there <= 1'b0;
                end else if (free && may_residual) begin
                    residual_due <= 1'b0;
                    field_due <= 1'b1;
                end else if (free && may_frame) begin
                    residual_due <= 1'b1;
                end
                if (residual_written) begin
                    residual_there <= 1'b1;
                end
                fields_held <= fields_held + {1'b0, start[2]} - {1'b0, frame_released};
                if (reset) begin
                    start[2:1] <= 2'd0;
                    residual_due <= 1'b0;
                    field_due <= 1'b0;
                    residual_there <= 1'b0;
                    fields_held <= 2'd0;
                end
            end
        end else begin : gen_one_program
            assign may_field = 1'b0;
            assign may_residual = 1'b0;
            assign field_waits = 1'b0;
            wire _unused = &{1'b0, residual_written, friction_known};
        end
    endgenerate

endmodule

`default_nettype wire
