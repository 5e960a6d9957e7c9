// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// The passes over a frame's taxels, one after the other, each a fixed number of cycles behind the last step of the one
// before: until what that has written can be read.

`default_nettype none

module sptfra_regions_passes #(
    parameter CONTACTS = 4,
    parameter WEIGHT_LATENCY = 4
) (
    input  wire clock,
    input  wire reset,
    input  wire start,
    input  wire several, // bodies with a region, when they are counted
    // The walk
    input  wire last, // step of it
    output wire begins,
    output wire begins_back,
    // The pass that it is of
    output wire idle,
    output wire blobs,
    output wire bodies,
    output wire there,
    output wire back,
    output wire list,
    // One cycle, when each taxel's region is counted, and at the ends
    output wire add_up,
    output reg  counted,
    output reg  parted
);

    generate
        if ((CONTACTS < 2) || (CONTACTS > 8)) begin : gen_check_contacts
            sptfra_error_contacts_must_be_2_to_8 invalid ();
        end
        if ((WEIGHT_LATENCY < 1) || (WEIGHT_LATENCY > 16)) begin : gen_check_latency
            sptfra_error_a_weight_comes_1_to_16_cycles_behind_its_address invalid ();
        end
    endgenerate

    localparam [2:0] IDLE = 3'd0;
    localparam [2:0] BLOBS = 3'd1;
    localparam [2:0] BODIES = 3'd2;
    localparam [2:0] COUNTED = 3'd3;
    localparam [2:0] THERE = 3'd4;
    localparam [2:0] BACK = 3'd5;
    localparam [2:0] LIST = 3'd6;
    localparam [31:0] AFTER_BLOBS = WEIGHT_LATENCY + 3;
    localparam [31:0] AFTER_BACK = CONTACTS + 1;
    localparam [31:0] TO_ADDING = CONTACTS - 1;

    reg [2:0] pass;
    reg [4:0] left; // cycles until the next one
    wire next = (left == 5'd1);
    wire goes_on = (pass == COUNTED) && several;

    assign idle = (pass == IDLE);
    assign blobs = (pass == BLOBS);
    assign bodies = (pass == BODIES);
    assign there = (pass == THERE);
    assign back = (pass == BACK);
    assign list = (pass == LIST);
    assign begins = start || (next && (blobs || there || back)) || goes_on;
    assign begins_back = start || there;
    assign add_up = back && (left == TO_ADDING[4:0]);

    always @(posedge clock) begin
        counted <= next && bodies;
        parted <= next && list;
        if (left != 5'd0) begin
            left <= left - 1'b1;
        end
        if (last) begin
            case (pass)
                BLOBS: left <= AFTER_BLOBS[4:0];
                BODIES: left <= 5'd3;
                THERE: left <= 5'd3;
                BACK: left <= AFTER_BACK[4:0];
                default: left <= 5'd1;
            endcase
        end
        if (next) begin
            pass <= list ? IDLE : pass + 1'b1;
        end
        if (pass == COUNTED) begin
            pass <= several ? THERE : IDLE;
        end
        if (start) begin
            pass <= BLOBS;
        end
        if (reset) begin
            pass <= IDLE;
            left <= 5'd0;
            counted <= 1'b0;
            parted <= 1'b0;
        end
    end

`ifdef SIMULATION
    always @(posedge clock) begin
        if (!reset && start && !idle && ((pass != COUNTED) || several)) begin
            $fdisplay(32'h80000002, "%m: a frame comes before the one before is done");
            $finish;
        end
    end
`endif

endmodule

`default_nettype wire
